import type { Event, Frame, SessionDescription } from '../client/index';
import { RequestError } from '../client/index';
import { Grabber } from './grab/grabber';
import { ConnectionLine } from './panel/connection_line';
import { Counters } from './panel/counters';
import { element } from './panel/elements';
import { Hint } from './panel/hint';
import { describeGuard, Notices } from './panel/notices';
import { showObstacle } from './panel/obstacle';
import { Playback } from './panel/playback';
import { Scenes } from './panel/scenes';
import { now } from './stream/clock';
import { NewestFrame } from './stream/newest_frame';
import { Stream } from './stream/stream';
import type { Report } from './stream/stream';
import { HeldMarker } from './view/held_marker';
import { theme } from './view/palette';
import { Stage } from './view/stage';
import { World } from './view/world';

/** Joins the stream from the server, the drawn world and the panel. */
export class App {
  private readonly canvas = element('view', HTMLCanvasElement);
  private readonly stream = new Stream(location.href, (report) => this.handle(report));
  private readonly darkness = window.matchMedia('(prefers-color-scheme: dark)');
  private readonly world = new World(theme(this.darkness.matches));
  private readonly marker = new HeldMarker();
  private readonly stage = new Stage(this.canvas, () => this.showNewest());
  private readonly grabber = new Grabber(
    this.stage,
    this.world,
    this.marker,
    this.stream.request,
    (error) => this.refuse(error),
  );
  private readonly connection = new ConnectionLine(() => this.stream.open());
  private readonly counters = new Counters(now);
  private readonly notices = new Notices();
  private readonly hint = new Hint();
  private readonly scenes = new Scenes((scene) => this.command('scene.load', { scene }));
  private readonly playback = new Playback({
    play: () => this.command('control.play', {}),
    pause: () => this.command('control.pause', {}),
    step: () => this.command('control.step', {}),
    reset: () => this.command('control.reset', {}),
    setSpeed: (speed) => this.command('control.set_speed', { speed }),
  });
  private description: SessionDescription | undefined;
  private clockOffset: number | undefined;
  private readonly newest = new NewestFrame(this.stream);

  start(): void {
    this.stage.scene.add(this.world.group, this.marker.group);
    this.paint();
    this.watchContext();
    this.darkness.addEventListener('change', () => this.paint());
    // Hidden pages are not drawn.
    document.addEventListener('visibilitychange', () => this.stream.watch(!document.hidden));
    this.stream.watch(!document.hidden);
    this.stream.open();
  }

  /** Browsers take the graphics away from pages, for instance when the machine sleeps. */
  private watchContext(): void {
    this.canvas.addEventListener('webglcontextlost', () =>
      showObstacle('The browser has stopped the drawing. It goes on when the browser allows it.'),
    );
    this.canvas.addEventListener('webglcontextrestored', () => {
      showObstacle(undefined);
      this.stage.invalidate();
    });
  }

  private paint(): void {
    const look = theme(this.darkness.matches);
    this.world.paint(look);
    this.stage.paint(look);
  }

  private handle(report: Report): void {
    switch (report.type) {
      case 'state':
        this.connection.show(report.state);
        if (report.state.name !== 'open') this.leave();
        break;
      case 'description':
        this.describe(report.description);
        break;
      case 'event':
        this.handleEvent(report.event);
        break;
      case 'frame':
        this.counters.addFrame(report.bytes);
        this.newest.put(report.frame);
        break;
      case 'clock':
        this.clockOffset = report.offset;
        break;
      case 'fault':
        this.notices.add('error', `The server sent ${report.message}.`);
        break;
    }
  }

  private handleEvent({ event, params }: Event): void {
    switch (event) {
      case 'session.status':
        this.counters.showStatus(params);
        this.playback.showPlaying(params.playing);
        this.playback.showSpeed(params.speed);
        break;
      case 'session.guard':
        this.notices.add(
          params.recovered ? 'warning' : 'error',
          describeGuard(params, this.description),
        );
        break;
      case 'session.closed':
        this.leave();
        this.notices.add('warning', `The session was closed: ${params.reason}`);
        break;
      case 'session.configured':
      case 'control.requested':
      case 'presence.changed':
      case 'grab.ended':
      case 'session.description': // comes as a report of its own
        break;
    }
  }

  /** A scene or its bodies have changed, or the session is entered anew. */
  private describe(description: SessionDescription): void {
    const isEntry = this.canvas.dataset.joined !== 'true';
    this.grabber.release();
    // A view that the user has chosen is kept while the scene stays.
    if (description.scene !== this.description?.scene) this.stage.reframe();
    this.description = description;
    this.newest.skip(); // what was there before
    this.world.describe(description);
    this.scenes.describe(description);
    this.playback.showPlaying(description.playing);
    this.playback.showSpeed(description.speed);
    this.canvas.dataset.scene = description.scene;
    delete this.canvas.dataset.tick; // until a frame of this description is drawn
    if (isEntry) this.enter();
  }

  private enter(): void {
    this.enable(true);
    this.hint.begin();
    this.stream.request('scene.list', {}).then(
      ({ scenes }) => this.scenes.list(scenes),
      (error: unknown) => this.refuse(error),
    );
  }

  private leave(): void {
    this.newest.forget();
    this.counters.clearRates();
    this.enable(false);
  }

  private enable(enabled: boolean): void {
    this.canvas.dataset.joined = String(enabled);
    this.playback.enable(enabled);
    this.scenes.enable(enabled);
    this.grabber.enable(enabled);
  }

  private command(...request: Parameters<Stream['request']>): void {
    this.stream.request(...request).catch((error: unknown) => {
      this.refuse(error);
      this.scenes.refresh();
    });
  }

  /** What the server refuses is said; that the line is down is seen from the connection's state. */
  private refuse(error: unknown): void {
    if (!(error instanceof RequestError)) throw error;
    if (error.kind !== 'disconnected') this.notices.add('error', error.message);
  }

  private showNewest(): void {
    const frame = this.newest.take();
    if (frame) this.showFrame(frame);
    this.grabber.update();
  }

  private showFrame(frame: Frame): void {
    if (!this.world.show(frame)) {
      this.stream.reuse(frame);
      return;
    }
    this.newest.use(frame);
    this.connection.showFrame(frame.header);
    this.stage.follow(this.world.bounds);
    this.counters.showFrame(frame, this.clockOffset);
    this.canvas.dataset.tick = String(frame.header.tick);
    this.stage.invalidate();
  }
}
