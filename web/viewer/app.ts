import type { Event, Frame, SessionDescription } from '../client/index';
import { RequestError } from '../client/index';
import { matterOf } from './build/matter';
import { SceneDocument } from './build/scene_document';
import { Controls } from './controls';
import { Curves } from './curves/curves';
import { Grabber } from './grab/grabber';
import { KeyGrab } from './grab/key_grab';
import { Links } from './links/links';
import { addCameraKeys } from './panel/camera_keys';
import { ConnectionLine } from './panel/status/connection_line';
import { Counters } from './panel/status/counters';
import { element } from './panel/elements';
import { describeError, needsControl } from './panel/errors';
import { eventInWords } from './panel/event_words';
import { Hint } from './panel/hint';
import { Inspector } from './panel/inspector';
import { Keys } from './panel/keys';
import { Notices } from './panel/notices';
import type { Remedy } from './panel/notices';
import { showObstacle, watchGraphics } from './panel/obstacle';
import { Sheet } from './panel/sheet';
import { LiveSummary } from './panel/status/live_summary';
import { ThemeSwitch } from './panel/theme_switch';
import { ViewOptions } from './panel/view_options';
import { Company } from './people/company';
import { addressOf } from './stream/address';
import { now } from './stream/clock';
import { Playout } from './stream/playout';
import { kRecordedSession, linkedRecording } from './stream/recording_file';
import { chosenSession, Stream } from './stream/stream';
import type { Report } from './stream/stream';
import { WholePicture } from './panel/status/whole_picture';
import { HeldMarker } from './view/held_marker';
import { linkedPose } from './view/base/pose';
import { View } from './view/view';
import './view/stage.css';
import './panel/panel.css';
import './panel/dialogs.css';
import './people/people.css';
import './panel/bar.css';
import './panel/phone.css';

/** Connects the server's stream, the drawn world and the panel. */
export class App {
  private readonly canvas = element('view', HTMLCanvasElement);
  private readonly stream = new Stream(location.href, (report) => this.handle(report));
  private readonly whole = new WholePicture(() => this.stream.refresh());
  private readonly playout = new Playout(this.stream);
  private readonly view = new View(this.canvas, this.stream, this.playout, () => this.showNewest());
  private readonly stage = this.view.stage;
  private readonly world = this.view.world;
  private readonly marker = new HeldMarker();
  private readonly grabber = new Grabber(
    this.stage,
    this.world,
    this.marker,
    this.stream.request,
    (error) => this.refuse(error),
    (body, particle) => this.inspector.inspect(body, particle),
  );
  private readonly connection = new ConnectionLine(
    () => this.stream.open(),
    () => {
      this.go(undefined);
      this.stream.open();
    },
    () => chosenSession(location.href) !== undefined,
  );
  private readonly counters = new Counters(now);
  private readonly notices = new Notices();
  private readonly keys = new Keys();
  private readonly summary = new LiveSummary();
  private readonly inspector = new Inspector(
    (body, particle) => {
      const found = this.world.particle(body, particle);
      return found && { ...found, time: this.shownTime };
    },
    (name, particles) => matterOf(this.document, name, particles),
  );
  private readonly desk = {
    request: this.stream.request,
    refuse: (error: unknown) => this.refuse(error),
    fail: (words: string) => this.notices.add('error', words),
    say: (words: string) => this.notices.add('warning', words),
  };
  private readonly document = new SceneDocument(this.stream.request);
  private readonly company = new Company(this.view, this.desk, (body) => this.nameOfBody(body));
  private readonly controls = new Controls(this.desk, this.view, this.keys, {
    document: this.document,
    nameOfBody: (body) => this.nameOfBody(body),
    placing: (isPlacing) => (this.grabber.isPaused = isPlacing),
    go: (session) => this.go(session),
    stream: this.stream,
  });
  private readonly curves = new Curves(this.desk, () => this.counters.figures);
  private readonly links = new Links(this.desk, this.view);
  private readonly hint = new Hint();
  private shownTime = 0;
  private shownTick = 0;
  /** The camera pose of the page's link; applied to the first description. */
  private linkedPose = linkedPose(location.href);
  private description: SessionDescription | undefined;
  private clockOffset: number | undefined;

  start(): void {
    this.stage.scene.add(this.marker.group);
    new ViewOptions(this.view).mount();
    this.links.mount();
    new Sheet();
    this.addKeys();
    this.company.people.subscribe(() => this.summary.showPeople(this.company.people));
    watchGraphics(this.canvas, () => this.view.paint()); // the colours are lost with the context
    window.addEventListener('popstate', () => this.stream.go(chosenSession(location.href)));
    // Hidden pages are not drawn.
    document.addEventListener('visibilitychange', () => this.stream.watch(!document.hidden));
    this.stream.watch(!document.hidden);
    const recording = linkedRecording(location.href);
    if (recording === undefined) this.stream.open();
    else this.stream.play(recording);
  }

  private handle(report: Report): void {
    switch (report.type) {
      case 'state':
        this.connection.show(report.state);
        this.summary.showConnection(report.state);
        if (report.state.name !== 'open') this.leave();
        break;
      case 'joined':
        this.connection.join();
        this.company.people.join(report.joined);
        break;
      case 'description':
        this.describe(report.description);
        break;
      case 'event':
        this.handleEvent(report.event);
        break;
      case 'frame':
        this.counters.addFrame(report.bytes);
        this.playout.put(report.frame, now());
        break;
      case 'recorded':
        this.showRecorded();
        break;
      case 'unreadable':
        this.refuseRecording(report.message);
        break;
      case 'clock':
        this.clockOffset = report.offset;
        break;
      case 'broken':
        showObstacle(
          'page',
          'A part of this page failed or was not loaded. Reload the page. If this does not help, inform the operator of the server.',
        );
        break;
      case 'fault':
        this.notices.add('error', `The server sent ${report.message}.`);
        break;
    }
  }

  private handleEvent(event: Event): void {
    const words = eventInWords(event, this.description);
    if (words) this.notices.add(words.level, words.text, this.answerTo(event));
    if (event.event === 'session.status') {
      this.counters.showStatus(event.params);
      this.summary.showStatus(event.params);
      this.curves.showStatus(event.params);
      this.whole.showStatus(event.params);
    }
    if (event.event === 'session.closed') this.leave();
    this.company.handle(event);
    this.controls.handle(event);
  }

  /** Returns the action that a message about the event offers. */
  private answerTo({ event, params }: Event): Remedy | undefined {
    if (event !== 'control.requested') return undefined;
    return { label: 'Give control', act: () => this.company.giveControl(params.participant) };
  }

  /** Called after a change of the scene or its bodies, and after joining. */
  private describe(description: SessionDescription): void {
    const isEntry = this.canvas.dataset.joined !== 'true';
    const isNew =
      description.scene !== this.description?.scene ||
      description.session !== this.description.session;
    // The user's view remains until another scene is loaded.
    if (isNew) this.stage.reframe();
    if (isNew) this.inspector.close();
    // A reset, or a saved state.
    const isEarlier = description.tick < this.shownTick;
    this.shownTick = description.tick;
    this.grabber.describe(description, isNew || isEarlier);
    this.description = description;
    this.document.forget();
    this.playout.skip(); // discards frames of the previous description
    this.view.describe(description);
    this.controls.describe(description, isNew, isEarlier);
    this.summary.describe(description);
    this.curves.describe(description, isNew);
    this.links.describe();
    this.canvas.dataset.scene = description.scene;
    delete this.canvas.dataset.tick; // until a frame of this description is drawn
    this.enable(true);
    if (isEntry) this.hint.begin();
    if (isEntry && description.session !== kRecordedSession) this.controls.enter();
  }

  /** Called when a recording is open, before its description. */
  private showRecorded(): void {
    this.leave();
    this.clockOffset = undefined;
    this.connection.showRecorded();
  }

  private refuseRecording(message: string): void {
    const words = `The recording cannot be shown: ${message}.`;
    this.notices.add('error', words);
    if (this.canvas.dataset.joined !== 'true') showObstacle('server', words);
  }

  private leave(): void {
    this.playout.forget();
    this.counters.clearRates();
    this.enable(false);
  }

  private enable(isJoined: boolean): void {
    this.canvas.dataset.joined = String(isJoined);
    this.grabber.enable(isJoined && !this.description?.replay);
    // A recording has no participants, statistics and connections.
    const hasServer = isJoined && this.description?.session !== kRecordedSession;
    this.company.enable(hasServer);
    this.controls.enable(isJoined);
    this.summary.enable(isJoined);
    this.curves.enable(hasServer);
    this.links.enable(hasServer);
  }

  /** Switches to another session; undefined: the server's first. */
  private go(session: string | undefined): void {
    history.pushState(undefined, '', addressOf(location.href, session));
    this.stream.go(session);
  }

  private addKeys(): void {
    const { keys } = this;
    const theme = new ThemeSwitch();
    const act = (words: string, key: string, action: () => void): void =>
      keys.add({ keys: [key], sign: key.toUpperCase(), words, act: action });
    act('share this session', 'l', () => this.company.share.open());
    act('switch between light, dark and system theme', 't', () => theme.next());
    new KeyGrab(
      keys,
      this.grabber,
      this.stage,
      this.world,
      () => this.description?.bodies.map(({ body }) => body) ?? [],
      (body) => this.summary.showHeld(body === undefined ? undefined : this.nameOfBody(body)),
    );
    addCameraKeys(keys, this.stage, () => {
      this.stage.reframe();
      this.stage.follow(this.world.bounds);
    });
  }

  private nameOfBody(id: number): string {
    return this.description?.bodies.find(({ body }) => body === id)?.name ?? `body ${id}`;
  }

  /** Reports a rejected request. The connection's state shows a lost connection. */
  private refuse(error: unknown): void {
    if (!(error instanceof RequestError)) throw error;
    if (error.kind === 'disconnected') return;
    const words = describeError(error);
    if (!needsControl(error)) return this.notices.add('error', words);
    const remedy = { label: 'Ask for control', act: () => this.company.askForControl() };
    this.notices.add('warning', words, remedy);
  }

  private showNewest(): void {
    this.playout.advance(now(), (frame) => this.showFrame(frame));
    this.view.move(now());
    this.grabber.update();
    this.company.cursors.update();
    this.controls.update();
    this.inspector.update(this.description);
  }

  private showFrame(frame: Frame): boolean {
    if (!this.view.show(frame)) return false;
    const { header } = frame;
    this.connection.showFrame(header);
    this.whole.showFrame(header);
    this.stage.follow(this.world.bounds);
    this.links.follow();
    if (this.linkedPose) this.stage.pose = this.linkedPose;
    this.linkedPose = undefined;
    this.shownTime = header.time;
    this.shownTick = header.tick;
    this.summary.showFrame(header);
    this.controls.showTick(header.tick);
    this.counters.showFrame(frame, this.clockOffset);
    this.canvas.dataset.tick = String(header.tick);
    return true;
  }
}
