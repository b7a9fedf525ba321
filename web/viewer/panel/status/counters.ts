import type { Frame, SessionStatus } from '../../../client/index';
import { element } from '../elements';
import { formatBytes, formatCount, formatError, formatFactor } from '../format';
import { formatMilliseconds, formatSeconds } from '../format';
import { FrameMeter } from './frame_meter';
import { qualityInWords } from './quality';

/** The update interval of figures that change with every frame [ms], for readability. */
const kReadableMs = 250;

function field(id: string): HTMLElement {
  return element(id, HTMLElement);
}

/** Writes a figure as formatted text, and as a number to `data-value`. */
function write(target: HTMLElement, value: number, text: string): void {
  target.dataset.value = String(value);
  target.textContent = text;
}

/** Render passes and draw calls of a picture, and its share of the display's resolution. */
export interface Drawing {
  passes: number;
  calls: number;
  scale: number;
}

/** The figures at the end of the panel. */
export class Counters {
  private readonly tick = field('tick');
  private readonly time = field('time');
  private readonly rate = field('rate');
  private readonly accuracyRow = field('accuracy-row');
  private readonly accuracy = field('accuracy');
  private readonly particles = field('particles');
  private readonly frameBytes = field('frame-bytes');
  private readonly byteRate = field('byte-rate');
  private readonly frameAge = field('frame-age');
  private readonly dropped = field('dropped');
  private readonly quality = field('quality');
  private readonly work = field('drawing');
  private readonly meter = new FrameMeter();
  private age: number | undefined;
  private lastBytes = 0;

  /** `drawing` returns the work of the last picture, and the resolution of moving pictures. */
  constructor(
    private readonly now: () => number,
    private readonly drawing: () => Drawing,
  ) {
    window.setInterval(() => this.writeRates(), kReadableMs);
  }

  /** Counts a received frame. */
  addFrame(bytes: number): void {
    this.meter.add(this.now(), bytes);
    this.lastBytes = bytes;
  }

  /** Displays a drawn frame. `clockOffset`: the server's time minus the local time [s]. */
  showFrame({ header, dropped }: Frame, clockOffset: number | undefined): void {
    this.showTick(header.tick, header.time);
    this.showRate(header.realTimeFactor, header.slow);
    write(this.dropped, dropped, formatCount(dropped));
    this.quality.textContent = qualityInWords(header);
    // The error of the offset, half a round trip, can make the age negative.
    this.age =
      clockOffset === undefined
        ? undefined
        : Math.max(0, this.now() + clockOffset - header.published);
  }

  /** Clears the rates after a loss of the connection. */
  clearRates(): void {
    this.age = undefined;
    this.lastBytes = 0;
  }

  /** The age of the picture [s], if known, and the rate of received bytes. */
  get figures(): { age: number | undefined; bytesPerSecond: number } {
    return { age: this.age, bytesPerSecond: this.meter.bytesPerSecond(this.now()) };
  }

  showStatus(status: SessionStatus): void {
    this.showTick(status.tick, status.time);
    // Frames report slowness, because each change of it sends a frame.
    this.showRate(status.real_time_factor, this.rate.dataset.slow === 'true');
    write(this.particles, status.particles, formatCount(status.particles));
    this.showAccuracy(status.governor);
  }

  private showTick(tick: number, time: number): void {
    write(this.tick, tick, formatCount(tick));
    write(this.time, time, formatSeconds(time));
  }

  private showRate(factor: number, slow: boolean): void {
    this.rate.dataset.slow = String(slow);
    write(this.rate, factor, (slow ? 'slow, ' : '') + formatFactor(factor));
  }

  private showAccuracy(governor: SessionStatus['governor']): void {
    this.accuracyRow.hidden = governor === undefined;
    if (!governor) return;
    const reduced = governor.point > 0 ? 'reduced, ' : '';
    write(this.accuracy, governor.error, `${reduced}error ${formatError(governor.error)}`);
  }

  private writeRates(): void {
    const bytesPerSecond = this.meter.bytesPerSecond(this.now());
    write(this.frameBytes, this.lastBytes, formatBytes(this.lastBytes));
    write(this.byteRate, bytesPerSecond, `${formatBytes(bytesPerSecond)}/s`);
    this.writeDrawing();
    if (this.age === undefined) this.frameAge.textContent = '–';
    else write(this.frameAge, this.age, formatMilliseconds(this.age));
  }

  private writeDrawing(): void {
    const { passes, calls, scale } = this.drawing();
    Object.assign(this.work.dataset, { passes, calls, scale });
    const share = scale < 1 ? `, ${Math.round(100 * scale)} % resolution` : '';
    const text = `${passes} passes, ${calls} draw calls${share}`;
    if (this.work.textContent !== text) this.work.textContent = text;
  }
}
