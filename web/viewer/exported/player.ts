import type { Frame, SessionDescription } from '../../client/index';
import { RequestError } from '../../client/index';
import { element } from '../panel/elements';
import { showObstacle, watchGraphics } from '../panel/obstacle';
import { ReplayBar } from '../replay/replay_bar';
import { now } from '../stream/clock';
import { Playout } from '../stream/playout';
import { Stream } from '../stream/stream';
import type { Place, Report } from '../stream/stream';
import { View } from '../view/view';
import '../style.css';
import '../view/stage.css';
import './player.css';

/** The page has no server. Its address may be a data: URL, to which no address is relative. */
const kNoPlace: Place = { url: '', session: undefined, token: undefined, base: location.href };

/** The page of an exported recording: the picture and the time line. */
class Player {
  private readonly canvas = element('view', HTMLCanvasElement);
  private readonly stream = new Stream(kNoPlace, (report) => this.handle(report));
  private readonly playout = new Playout(this.stream);
  private readonly view = new View(this.canvas, this.stream, this.playout, () => this.draw());
  private readonly bar: ReplayBar;
  private playing = true;
  private description: SessionDescription | undefined;

  constructor() {
    const fail = (words: string): void => showObstacle('server', words);
    const desk = {
      request: this.stream.request,
      refuse: (error: unknown) => {
        if (!(error instanceof RequestError)) throw error;
        fail(error.message);
      },
      fail,
      say: fail,
    };
    this.bar = new ReplayBar(desk, this.view.stage, {
      togglePlaying: () => this.toggle(),
      loop: (wanted) => this.stream.loop(wanted),
      nameOfBody: () => '',
    });
  }

  start(recording: Blob): void {
    watchGraphics(this.canvas, () => this.view.paint());
    window.addEventListener('keydown', (event) => {
      const isFree = event.target === document.body || event.target === this.canvas;
      if (event.key !== ' ' || !isFree) return;
      event.preventDefault();
      this.toggle();
    });
    document.addEventListener('visibilitychange', () => this.stream.watch(!document.hidden));
    this.stream.play(recording);
  }

  private toggle(): void {
    void this.stream.request(this.playing ? 'control.pause' : 'control.play', {});
  }

  private handle(report: Report): void {
    switch (report.type) {
      case 'description':
        this.describe(report.description);
        break;
      case 'event':
        this.bar.handle(report.event);
        if (report.event.event === 'session.status') this.playing = report.event.params.playing;
        break;
      case 'frame':
        this.playout.put(report.frame, now());
        break;
      case 'unreadable':
        showObstacle('server', `The recording cannot be shown: ${report.message}.`);
        break;
      case 'broken':
        showObstacle('page', 'A part of this page failed. Reload the page.');
        break;
    }
  }

  private describe(description: SessionDescription): void {
    if (!this.description) this.view.stage.reframe();
    this.description = description;
    this.playing = description.playing;
    this.playout.skip();
    this.view.describe(description);
    this.bar.describe(description);
    this.canvas.dataset.joined = 'true';
  }

  private draw(): void {
    this.playout.advance(now(), (frame) => this.show(frame));
    this.view.move(now());
    this.bar.update();
  }

  private show(frame: Frame): boolean {
    if (!this.view.show(frame)) return false;
    const { stage, world } = this.view;
    stage.follow(world.framed, world.bounds);
    this.bar.showTick(frame.header.tick);
    this.canvas.dataset.tick = String(frame.header.tick);
    return true;
  }
}

try {
  const { vatRecording } = window;
  if (!vatRecording) throw new Error('the page has no recording');
  new Player().start(vatRecording);
} catch (error) {
  showObstacle('page', 'This page needs a browser with WebGL 2.');
  throw error;
}
