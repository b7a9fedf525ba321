import type { Frame } from '../../client/index';
import { PlayoutDelay } from './playout_delay';

/** Functions of the server and the worker that frames are returned to. */
export interface FrameGivers {
  acknowledge(number: number): void;
  /** Takes back an unused frame. */
  reuse(frame: Frame): void;
}

/** After a longer time without a frame, motion restarts [s]. */
const kRest = 0.25;

/**
 * Shows frames with a delay after their publication, so that the picture can be interpolated between
 * frames. Without `smooth`, or while the session is paused, frames are shown on arrival.
 *
 * Frames are acknowledged in the next animation frame, shown or not. The server stops sending when
 * its window of unacknowledged frames is full.
 */
export class Playout {
  smooth = false;
  private readonly waiting: Frame[] = [];
  /** The frame that the picture approaches, and the previous frame. */
  private shown: Frame | undefined;
  private before: Frame | undefined;
  /** A previous frame that was forgotten. The picture uses it until the next frame is shown. */
  private replaced: Frame | undefined;
  private readonly delay = new PlayoutDelay();
  private newestNumber: number | undefined;

  constructor(private readonly givers: FrameGivers) {}

  /** Adds a frame that was received at `now` [s]. */
  put(frame: Frame, now: number): void {
    this.waiting.push(frame);
    this.newestNumber = frame.header.number;
    this.delay.add(frame.header.published, now);
  }

  /** The delay for smooth motion [s]. */
  get delaySeconds(): number {
    return this.smooth ? this.delay.seconds : 0;
  }

  /**
   * Passes the frames that are due at `now` to `show`, in order. `show` returns whether it uses the
   * frame. Acknowledges all received frames. Called once per animation frame.
   */
  advance(now: number, show: (frame: Frame) => boolean): void {
    if (this.newestNumber !== undefined) this.givers.acknowledge(this.newestNumber);
    this.newestNumber = undefined;
    const time = this.timeAt(now);
    while (this.waiting[0] && this.isDue(time)) {
      const frame = this.waiting.shift()!;
      if (show(frame)) this.follow(frame);
      else this.givers.reuse(frame);
    }
  }

  /** Returns the interpolation parameter: 0 at the previous frame, 1 at the shown frame. */
  phaseAt(now: number): number {
    const { before, shown } = this;
    if (!before || !shown) return 1;
    const end = shown.header.published;
    const begin = Math.max(before.header.published, end - kRest);
    return Math.min(Math.max((this.timeAt(now) - begin) / (end - begin), 0), 1);
  }

  /** Acknowledges and discards all frames. The next frame belongs to another scene. */
  skip(): void {
    const last = this.waiting.at(-1);
    if (last) this.givers.acknowledge(last.header.number);
    this.forget();
  }

  /** Discards all frames without acknowledgement, because their subscription has ended. */
  forget(): void {
    for (const frame of this.waiting) this.givers.reuse(frame);
    this.waiting.length = 0;
    this.replaced ??= this.before;
    this.before = this.newestNumber = undefined;
  }

  /** Returns the publication time to show at `now`. A paused session has no delay. */
  private timeAt(now: number): number {
    const newest = this.waiting.at(-1) ?? this.shown;
    if (!this.smooth || !newest?.header.playing) return Infinity;
    return this.delay.timeAt(now);
  }

  /** Returns whether the picture has reached the shown frame, so that the next is due. */
  private isDue(time: number): boolean {
    return !this.shown || time >= this.shown.header.published;
  }

  private follow(frame: Frame): void {
    for (const last of [this.replaced, this.before]) if (last) this.givers.reuse(last);
    this.replaced = undefined;
    this.before = this.shown;
    this.shown = frame;
  }
}
