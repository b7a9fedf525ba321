import type { Frame, SessionStatus } from '../../client/index';
import { element } from './elements';
import { formatBytes, formatCount, formatFactor, formatMilliseconds } from './format';
import { formatSeconds } from './format';
import { FrameMeter } from './frame_meter';
import { qualityInWords } from './quality';

/** Figures that change with every frame are written this often, so that they can be read. */
const kReadableMs = 250;

function field(id: string): HTMLElement {
  return element(id, HTMLElement);
}

/** A figure as text for people, and as a plain number in `data-value`. */
function write(target: HTMLElement, value: number, text: string): void {
  target.dataset.value = String(value);
  target.textContent = text;
}

/** The figures at the panel's end. */
export class Counters {
  private readonly tick = field('tick');
  private readonly time = field('time');
  private readonly rate = field('rate');
  private readonly particles = field('particles');
  private readonly frameBytes = field('frame-bytes');
  private readonly byteRate = field('byte-rate');
  private readonly frameAge = field('frame-age');
  private readonly dropped = field('dropped');
  private readonly quality = field('quality');
  private readonly meter = new FrameMeter();
  private age: number | undefined;
  private lastBytes = 0;

  constructor(private readonly now: () => number) {
    window.setInterval(() => this.writeRates(), kReadableMs);
  }

  /** A frame came in. */
  addFrame(bytes: number): void {
    this.meter.add(this.now(), bytes);
    this.lastBytes = bytes;
  }

  /** A frame is drawn; `clockOffset` is how far the server's clock is ahead of ours [s]. */
  showFrame({ header, dropped }: Frame, clockOffset: number | undefined): void {
    this.showTick(header.tick, header.time);
    this.showRate(header.realTimeFactor, header.slow);
    write(this.dropped, dropped, formatCount(dropped));
    this.quality.textContent = qualityInWords(header);
    // Half a round trip of error can make a young frame seem to come from the future.
    this.age =
      clockOffset === undefined
        ? undefined
        : Math.max(0, this.now() + clockOffset - header.published);
  }

  /** Without a line to the server, nothing is known of the frames to come. */
  clearRates(): void {
    this.age = undefined;
    this.lastBytes = 0;
  }

  /** How old the picture is [s], as far as that is known, and what comes. */
  get figures(): { age: number | undefined; bytesPerSecond: number } {
    return { age: this.age, bytesPerSecond: this.meter.bytesPerSecond(this.now()) };
  }

  showStatus(status: SessionStatus): void {
    this.showTick(status.tick, status.time);
    // Whether it is slow is told by frames: where it changes, one comes.
    this.showRate(status.real_time_factor, this.rate.dataset.slow === 'true');
    write(this.particles, status.particles, formatCount(status.particles));
  }

  private showTick(tick: number, time: number): void {
    write(this.tick, tick, formatCount(tick));
    write(this.time, time, formatSeconds(time));
  }

  private showRate(factor: number, slow: boolean): void {
    this.rate.dataset.slow = String(slow);
    write(this.rate, factor, (slow ? 'slow, ' : '') + formatFactor(factor));
  }

  private writeRates(): void {
    const bytesPerSecond = this.meter.bytesPerSecond(this.now());
    write(this.frameBytes, this.lastBytes, formatBytes(this.lastBytes));
    write(this.byteRate, bytesPerSecond, `${formatBytes(bytesPerSecond)}/s`);
    if (this.age === undefined) this.frameAge.textContent = '–';
    else write(this.frameAge, this.age, formatMilliseconds(this.age));
  }
}
