import type { Frame } from '../../client/index';
import { PlayoutDelay } from './playout_delay';

/** The server and the worker, as far as frames go back to them. */
export interface FrameGivers {
  acknowledge(number: number): void;
  /** Takes a frame that is not needed any more. */
  reuse(frame: Frame): void;
}

/** A longer time than this without a frame is a rest, after which motion begins anew [s]. */
const kRest = 0.25;

/**
 * Shows frames at the times at which they were published, a little later, so that between two of
 * them the picture can be at every moment in between. Without `smooth`, or where the session stands
 * still, each is shown as it comes.
 *
 * Frames are acknowledged once the page could draw them, shown or not: once the server's window is
 * full of unacknowledged ones, it sends no more.
 */
export class Playout {
  smooth = false;
  private readonly waiting: Frame[] = [];
  /** The frame that the picture moves to, and the one that it comes from. */
  private shown: Frame | undefined;
  private before: Frame | undefined;
  private readonly delay = new PlayoutDelay();
  private newestNumber: number | undefined;

  constructor(private readonly givers: FrameGivers) {}

  /** A frame came, at `now` [s]. */
  put(frame: Frame, now: number): void {
    this.waiting.push(frame);
    this.newestNumber = frame.header.number;
    this.delay.add(frame.header.published, now);
  }

  /** How much later than it could be the picture is, for the motion to be smooth [s]. */
  get delaySeconds(): number {
    return this.smooth ? this.delay.seconds : 0;
  }

  /**
   * Hands the frames that are due at `now` to `show`, in order, once in each animation frame; it
   * returns whether it has taken the frame. All that came are acknowledged.
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

  /** How far the picture has come from the frame before (0) to the one shown (1). */
  phaseAt(now: number): number {
    const { before, shown } = this;
    if (!before || !shown) return 1;
    const end = shown.header.published;
    const begin = Math.max(before.header.published, end - kRest);
    return Math.min(Math.max((this.timeAt(now) - begin) / (end - begin), 0), 1);
  }

  /** Drops and acknowledges what waits, and begins anew: what comes next is of another scene. */
  skip(): void {
    const last = this.waiting.at(-1);
    if (last) this.givers.acknowledge(last.header.number);
    this.forget();
  }

  /** Without a word to the server: the subscription that the frames belonged to has ended. */
  forget(): void {
    for (const frame of this.waiting) this.givers.reuse(frame);
    if (this.before) this.givers.reuse(this.before);
    this.waiting.length = 0;
    this.before = this.newestNumber = undefined;
  }

  /** The time of publication that is shown at `now`; what stands still is shown at once. */
  private timeAt(now: number): number {
    const newest = this.waiting.at(-1) ?? this.shown;
    if (!this.smooth || !newest?.header.playing) return Infinity;
    return this.delay.timeAt(now);
  }

  /** The next frame is due once the picture has reached the one that it moves to. */
  private isDue(time: number): boolean {
    return !this.shown || time >= this.shown.header.published;
  }

  private follow(frame: Frame): void {
    if (this.before) this.givers.reuse(this.before);
    this.before = this.shown;
    this.shown = frame;
  }
}
