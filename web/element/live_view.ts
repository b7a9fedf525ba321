import type { Event, Frame, SessionDescription } from '../client/index';
import { RequestError } from '../client/index';
import { Grabber } from '../viewer/grab/grabber';
import { Held } from '../viewer/grab/held';
import { describeError } from '../viewer/panel/errors';
import { now } from '../viewer/stream/clock';
import { Playout } from '../viewer/stream/playout';
import { Stream } from '../viewer/stream/stream';
import type { Report } from '../viewer/stream/stream';
import type { Pose } from '../viewer/view/base/pose';
import { SettingsStore } from '../viewer/view/base/settings_store';
import { kNoShelf } from '../viewer/view/base/shelf';
import { HeldMarker } from '../viewer/view/held_marker';
import { View } from '../viewer/view/view';
import { Controls } from './controls';
import type { Source } from './source';

/** The options of a view. */
export interface LiveOptions {
  /** Settings of the view in the form of links. */
  view: string;
  pose: Pose | undefined;
  /** Whether the user can pull bodies and use the controls. */
  hasControls: boolean;
}

/** The picture of one session or recording, with its connection. */
export class LiveView {
  private readonly stream: Stream;
  private readonly playout: Playout;
  private readonly view: View;
  private readonly controls: Controls;
  private readonly grabber: Grabber | undefined;
  private pose: Pose | undefined;
  private description: SessionDescription | undefined;

  /** `say` shows a text in place of the picture; undefined removes it. */
  constructor(
    private readonly canvas: HTMLCanvasElement,
    source: Source,
    { view, pose, hasControls }: LiveOptions,
    private readonly say: (words: string | undefined) => void,
  ) {
    this.pose = pose;
    this.stream = new Stream(source.place, (report) => this.handle(report));
    this.playout = new Playout(this.stream);
    // Settings are not stored, because several viewers can be on one page.
    const settings = new SettingsStore(kNoShelf, view);
    this.view = new View(canvas, this.stream, this.playout, () => this.draw(), settings);
    this.controls = new Controls(this.stream.request, (error) => this.refuse(error));
    this.controls.element.hidden = !hasControls;
    if (hasControls && source.recording === undefined) this.grabber = this.makeGrabber();
    if (source.recording === undefined) this.stream.open();
    else this.stream.play(source.recording);
  }

  get controlElement(): HTMLElement {
    return this.controls.element;
  }

  /** Pauses the transmission while the picture is not visible. */
  watch(wanted: boolean): void {
    this.stream.watch(wanted);
  }

  dispose(): void {
    this.grabber?.enable(false);
    this.stream.close();
    this.view.dispose();
  }

  private makeGrabber(): Grabber {
    const { stage, world } = this.view;
    const marker = new HeldMarker();
    stage.scene.add(marker.group);
    return new Grabber(
      stage,
      world,
      marker,
      (start, failed) => new Held(this.stream.request, start, failed),
      (error) => this.refuse(error),
      () => undefined,
    );
  }

  private handle(report: Report): void {
    switch (report.type) {
      case 'state':
        if (report.state.name === 'open') break;
        this.grabber?.enable(false);
        this.playout.forget();
        if ('reason' in report.state) this.say(`Not connected: ${report.state.reason}.`);
        break;
      case 'description':
        this.describe(report.description);
        break;
      case 'event':
        this.handleEvent(report.event);
        break;
      case 'frame':
        this.playout.put(report.frame, now());
        break;
      case 'unreadable':
        this.say(`The recording cannot be shown: ${report.message}.`);
        break;
      case 'broken':
        this.say('The worker of the viewer was not loaded.');
        break;
    }
  }

  private handleEvent(event: Event): void {
    if (event.event === 'session.status') this.controls.showStatus(event.params);
    if (event.event === 'session.closed') this.say('The session has ended.');
  }

  private describe(description: SessionDescription): void {
    const { session, scene } = this.description ?? {};
    const isNew = description.session !== session || description.scene !== scene;
    if (isNew) this.view.stage.reframe();
    this.grabber?.describe(description, isNew);
    this.grabber?.enable(true);
    this.description = description;
    this.playout.skip();
    this.view.describe(description);
    this.controls.describe(description);
    this.canvas.dataset.joined = 'true';
  }

  private draw(): void {
    this.playout.advance(now(), (frame) => this.show(frame));
    this.view.move(now());
    this.grabber?.update();
  }

  private show(frame: Frame): boolean {
    if (!this.view.show(frame)) return false;
    this.say(undefined);
    const { stage, world } = this.view;
    stage.follow(world.framed, world.bounds);
    if (this.pose) this.view.stage.pose = this.pose;
    this.pose = undefined;
    this.canvas.dataset.tick = String(frame.header.tick);
    return true;
  }

  private refuse(error: unknown): void {
    if (!(error instanceof RequestError)) throw error;
    if (error.kind !== 'disconnected') this.say(describeError(error));
  }
}
