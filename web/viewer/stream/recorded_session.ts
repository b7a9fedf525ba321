import { emptyFrame, FrameDecoder, RequestError } from '../../client/index';
import type {
  Event,
  Frame,
  FrameRecording,
  MethodName,
  Params,
  RecordedScene,
  Result,
  SessionDescription,
} from '../../client/index';
import { kRecordedSession } from './recording_file';

export interface RecordedHandlers {
  onDescription(description: SessionDescription): void;
  onEvent(event: Event): void;
  /** Receives a decoded frame and its size. Call `acknowledge` after drawing it. */
  onFrame(frame: Frame, bytes: number): void;
  /** Returns an unused frame for the next decoding. */
  frameFor?(): Frame;
  /** Receives a message for the user. The recording pauses. */
  onFault(message: string): void;
}

/** The maximum number of unacknowledged frames. */
const kWindow = 2;
/** The maximum number of frames that are decoded for one picture. Slower viewers see slow motion. */
const kMostAtOnce = 8;
/** The period of status events [s]. */
const kStatusPeriod = 0.5;

/**
 * Plays a recording of frames as a replay session without a server. A position is the number of a
 * frame. After a seek, a new epoch begins, as in a replay of the server.
 */
export class RecordedSession {
  private decoder = new FrameDecoder();
  private readonly own = emptyFrame();
  /** The shown frame; -1 before the first. */
  private position = -1;
  /** The frame that was decoded last; -1 if the next one must be a key frame. */
  private decoded = -1;
  private scene: RecordedScene | undefined;
  private epoch = 0;
  private playing = true;
  private speed = 1;
  private loops = true;
  private isWatched = true;
  private isClosed = false;
  private isBusy = false;
  /** The time at which the frame `anchor.position` was due. */
  private anchor = { position: 0, at: 0 };
  private target: number | undefined;
  private seekers: (() => void)[] = [];
  private sent = 0;
  private acknowledged = 0;
  private time = 0;
  private particles = 0;
  private statusAt = -Infinity;
  private timer: ReturnType<typeof setTimeout> | undefined;

  /** `now` returns the time [s]. */
  constructor(
    private readonly recording: FrameRecording,
    private readonly handlers: RecordedHandlers,
    private readonly now: () => number,
  ) {}

  /** Plays from the beginning. */
  start(): void {
    this.target = 0;
    this.run();
  }

  close(): void {
    this.isClosed = true;
    clearTimeout(this.timer);
  }

  acknowledge(number: number): void {
    this.acknowledged = Math.max(this.acknowledged, number);
    this.run();
  }

  /** Pauses the clock while nothing is drawn. */
  watch(wanted: boolean): void {
    this.isWatched = wanted;
    this.acknowledged = this.sent;
    this.setAnchor();
    this.run();
  }

  /** Selects whether the recording restarts after its end. */
  loop(wanted: boolean): void {
    this.loops = wanted;
  }

  /** Executes a request of the page. Other methods than those of a replay need a server. */
  async request<M extends MethodName>(method: M, params: Params<M>): Promise<Result<M>> {
    return (await this.execute(method, params as Record<string, unknown>)) as Result<M>;
  }

  private get end(): number {
    return this.recording.frameCount - 1;
  }

  private async execute(method: MethodName, params: Record<string, unknown>): Promise<object> {
    switch (method) {
      case 'control.play':
        if (!this.playing && this.position === this.end) this.target ??= 0;
        this.change(() => (this.playing = true));
        break;
      case 'control.pause':
        this.change(() => (this.playing = false));
        break;
      case 'control.set_speed':
        this.change(() => (this.speed = Number(params.speed)));
        break;
      case 'control.step':
        this.change(() => (this.playing = false));
        await this.seek(this.position + Number(params.ticks ?? 1));
        break;
      case 'replay.seek':
        await this.seek(Number(params.position ?? params.tick));
        break;
      case 'replay.info':
        return this.info();
      default:
        throw new RequestError('disconnected', `${method}: a recording has no server`);
    }
    return { tick: this.position, position: this.position };
  }

  private info(): Result<'replay.info'> {
    return {
      tick: this.position,
      name: this.recording.sceneAt(Math.max(this.position, 0)).description.name,
      begin: 0,
      end: this.end,
      position: this.position,
      playing: this.playing,
      speed: this.speed,
      checkpoints: [],
      filled: true,
      hashes: 0,
      diverged: null,
      people: [],
    };
  }

  private change(act: () => void): void {
    act();
    this.setAnchor();
    this.tellStatus();
    this.run();
  }

  /** Resolves after the frame is shown. */
  private seek(position: number): Promise<void> {
    if (!Number.isFinite(position)) return Promise.resolve();
    this.target = Math.min(Math.max(Math.round(position), 0), this.end);
    return new Promise((resolve) => {
      this.seekers.push(resolve);
      this.run();
    });
  }

  private setAnchor(): void {
    this.anchor = { position: Math.max(this.position, 0), at: this.now() };
  }

  /** The time between two frames at the set speed [s]. */
  private get period(): number {
    return this.recording.frameSeconds / this.speed;
  }

  private run(): void {
    if (this.isBusy || this.isClosed) return;
    this.isBusy = true;
    void this.turns().finally(() => {
      this.isBusy = false;
      if (this.target === undefined) this.schedule();
      else this.run(); // a seek that came after the last turn
    });
  }

  private async turns(): Promise<void> {
    try {
      while (!this.isClosed && (await this.turn()));
    } catch (error) {
      this.playing = false;
      this.target = undefined;
      this.settleSeekers();
      this.tellStatus();
      this.handlers.onFault(error instanceof Error ? error.message : String(error));
    }
  }

  /** Shows the next frame if it is due. Returns whether there can be another one. */
  private async turn(): Promise<boolean> {
    if (this.target !== undefined) {
      const { target, seekers } = this;
      this.target = undefined;
      this.seekers = [];
      await this.show(target, true);
      for (const resolve of seekers) resolve();
      return true;
    }
    if (!this.playing || !this.isWatched || this.sent - this.acknowledged >= kWindow) return false;
    const passed = Math.floor((this.now() - this.anchor.at) / this.period + 1e-6);
    const due = this.anchor.position + passed;
    if (due <= this.position) return false;
    if (this.position === this.end) return this.finish();
    const next = Math.min(due, this.end, this.position + kMostAtOnce);
    await this.show(next, false);
    if (next < due) this.setAnchor(); // the page is slow
    return true;
  }

  private finish(): boolean {
    if (this.loops) {
      this.target = 0;
      return true;
    }
    this.playing = false;
    this.handlers.onEvent({
      event: 'replay.ended',
      params: { position: this.position, tick: this.position },
    });
    this.tellStatus();
    return false;
  }

  private async show(position: number, isSeek: boolean): Promise<void> {
    const scene = this.recording.sceneAt(position);
    const { frame, bytes } = await this.decodeTo(position);
    if (this.isClosed) return;
    this.position = position;
    if (isSeek) this.setAnchor();
    if (isSeek || scene !== this.scene) this.describe(scene);
    this.write(frame, isSeek);
    this.handlers.onFrame(frame, bytes);
    if (isSeek || this.now() - this.statusAt >= kStatusPeriod) this.tellStatus();
  }

  /** Decodes the frames from the last key frame or the present position on. */
  private async decodeTo(position: number): Promise<{ frame: Frame; bytes: number }> {
    const frame = this.handlers.frameFor?.() ?? this.own;
    const key = this.recording.keyBefore(position);
    let next = this.decoded < key || this.decoded >= position ? key : this.decoded + 1;
    this.decoded = -1;
    let bytes = 0;
    while (next <= position) {
      const { first, frames } = await this.recording.group(next);
      for (; next <= position && next < first + frames.length; ++next) {
        const encoded = frames[next - first]!;
        bytes = encoded.byteLength;
        this.decoder.decode(encoded, frame);
      }
    }
    this.decoded = position;
    return { frame, bytes };
  }

  /** Replaces the values of the recorded session by those of this one. */
  private write({ header, blocks }: Frame, isSeek: boolean): void {
    const late = (this.position - this.anchor.position) * this.period;
    header.playing = this.playing;
    header.slow = false;
    header.epoch = this.epoch;
    header.number = ++this.sent;
    header.stride = 1;
    header.tick = this.position;
    header.published = isSeek ? this.now() : this.anchor.at + late;
    header.realTimeFactor = this.speed;
    this.time = header.time;
    this.particles = 0;
    for (const block of blocks) {
      if ('positions' in block) this.particles += block.positions.length / 3;
    }
    for (const { kind, particles } of this.scene!.description.bodies) {
      if (kind === 'rigid') this.particles += particles;
    }
  }

  private describe(scene: RecordedScene): void {
    this.scene = scene;
    this.handlers.onDescription({
      ...scene.description,
      session: kRecordedSession,
      epoch: ++this.epoch,
      tick: this.position,
      playing: this.playing,
      speed: this.speed,
      tick_seconds: this.recording.frameSeconds,
      replay: { begin: 0, end: this.end, position: this.position },
    });
  }

  private tellStatus(): void {
    this.statusAt = this.now();
    if (!this.scene) return;
    const position = Math.max(this.position, 0);
    this.handlers.onEvent({
      event: 'session.status',
      params: {
        tick: position,
        time: this.time,
        playing: this.playing,
        speed: this.speed,
        real_time_factor: this.speed,
        clients: 0,
        particles: this.particles,
        position,
      },
    });
  }

  private settleSeekers(): void {
    for (const resolve of this.seekers.splice(0)) resolve();
  }

  private schedule(): void {
    clearTimeout(this.timer);
    if (this.isClosed || !this.playing || !this.isWatched || this.position < 0) return;
    if (this.sent - this.acknowledged >= kWindow) return; // continues with the acknowledgement
    const due = this.anchor.at + (this.position + 1 - this.anchor.position) * this.period;
    const delay = Math.max(1000 * (due - this.now()), 0);
    this.timer = setTimeout(() => this.run(), delay);
  }
}
