import type { Event, Frame, SessionDescription } from '../client/index';
import { RequestError } from '../client/index';
import { matterOf } from './build/matter';
import { SceneDocument } from './build/scene_document';
import { CameraControl } from './camera/camera_control';
import { Controls } from './controls';
import { Curves } from './curves/curves';
import { Grabber } from './grab/grabber';
import { Held } from './grab/held';
import { KeyGrab } from './grab/key_grab';
import { Links } from './links/links';
import { ConnectionLine } from './panel/status/connection_line';
import { Counters } from './panel/status/counters';
import { element } from './panel/elements';
import { describeError, needsControl } from './panel/errors';
import { eventInWords } from './panel/event_words';
import { ask } from './panel/desk';
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
import { linkParts } from './people/share';
import { addressOf, linkedMoment } from './stream/address';
import { now } from './stream/clock';
import { Playout } from './stream/playout';
import { kRecordedSession, linkedRecording } from './stream/recording_file';
import { chosenSession, placeOf, Stream } from './stream/stream';
import type { Report } from './stream/stream';
import { WholePicture } from './panel/status/whole_picture';
import { Push, Pusher } from './tools/push';
import { HeldMarker } from './view/held_marker';
import { linkedPose } from './view/base/pose';
import { shelfOf } from './view/base/shelf';
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
  // The memory is per tab, so that reloading the page resumes the participant.
  private readonly stream = new Stream(
    placeOf(location.href),
    (report) => this.handle(report),
    shelfOf(window, 'sessionStorage'),
  );
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
    (start, failed) =>
      this.pushes
        ? new Push(start, (body, drag) => void this.pusher.push(body, drag))
        : new Held(this.stream.request, start, failed),
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
  private readonly counters = new Counters(now, () => ({
    ...this.stage.work,
    scale: this.stage.movingScale,
  }));
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
  /** The address of the shown recording. */
  private address = linkedRecording(location.href);
  /** The parts of links that are known here. */
  private readonly shown = linkParts(
    () => this.controls.moment,
    () => (this.isRecorded ? this.address : undefined),
  );
  private readonly pusher = new Pusher(
    this.desk,
    this.document,
    (body) => this.world.describedBody(body),
    () => this.world.height,
  );
  private readonly company = new Company(
    this.view,
    this.desk,
    (body) => this.nameOfBody(body),
    this.shown,
  );
  private readonly controls = new Controls(this.desk, this.view, this.keys, {
    document: this.document,
    nameOfBody: (body) => this.nameOfBody(body),
    showNode: (node) => this.connection.showNode(node),
    marker: this.marker,
    say: (words) => this.desk.say(words),
    useTool: (tool) => {
      this.grabber.isPaused = tool === undefined;
      this.pushes = tool === 'push';
    },
    go: (session) => this.go(session),
    stream: {
      play: (file) => {
        this.address = undefined;
        this.stream.play(file);
      },
      loop: (wanted) => this.stream.loop(wanted),
    },
  });
  private readonly camera = new CameraControl(this.view, this.keys, {
    bodies: () => this.description?.bodies ?? [],
    moment: () => ({ scene: this.description?.scene ?? '', time: this.shownTime }),
    share: () => (this.company.share.isEnabled ? () => this.company.share.open() : undefined),
  });
  private readonly curves = new Curves(this.desk, () => this.counters.figures);
  private readonly links = new Links(this.desk, this.view);
  private readonly hint = new Hint();
  private shownTime = 0;
  private shownTick = 0;
  /** Whether drags push bodies; otherwise they pull. */
  private pushes = false;
  /** The camera pose and the position of the page's link; applied to the first description. */
  private linkedPose = linkedPose(location.href);
  private linkedMoment = linkedMoment(location.href);
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
    if (this.address === undefined) this.stream.open();
    else this.stream.play(this.address);
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
    if (event.event === 'session.moved') this.connection.showMove();
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
    this.camera.describe(description, isNew);
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
    if (description.replay) void this.seekLinked();
  }

  /** Pauses a replay or a recording at the position of the page's link. */
  private async seekLinked(): Promise<void> {
    const position = this.linkedMoment;
    this.linkedMoment = undefined;
    if (position === undefined) return;
    if (await ask(this.desk, 'control.pause', {}))
      await ask(this.desk, 'replay.seek', { position });
  }

  private get isRecorded(): boolean {
    return this.description?.session === kRecordedSession;
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
    const hasServer = isJoined && !this.isRecorded;
    this.company.enable(hasServer, isJoined && (!this.isRecorded || this.address !== undefined));
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
    this.camera.addKeys();
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
    this.camera.update(now());
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
    this.stage.follow(this.world.framed, this.world.bounds);
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
