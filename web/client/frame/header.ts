import { FrameError } from './frame_error.js';

/** The quantisation of a frame. Delta frames use that of their key frame. */
export interface FrameScale {
  /** A position is origin + quantum * integer, per axis [m]. */
  readonly origin: readonly [number, number, number];
  readonly quantum: number;
  /**
   * Quanta of speed [m/s], density [kg/m^3], pressure [Pa] and acceleration [m/s^2]; 0 if frames do
   * not contain the attribute.
   */
  readonly attributeQuanta: readonly [number, number, number, number];
}

export interface FrameHeader extends FrameScale {
  playing: boolean;
  /** The session runs slower than its set speed. */
  slow: boolean;
  /** Level of detail, 0 to 3, and whether the frame is restricted to a region. */
  detail: number;
  region: boolean;
  epoch: number;
  /** Counts the session's frames with new content. */
  number: number;
  /** This client receives every stride-th number. */
  stride: number;
  tick: number;
  /** Simulation time [s]. */
  time: number;
  /** Server's clock when the state was published [s since 1970]. */
  published: number;
  /** Simulated seconds per second. */
  realTimeFactor: number;
}

const kMagic = 0x46544156; // "VATF", little-endian
const kVersion = 2;
const kKnownFlags = 31; // allowed in all frames
const kAccelerationFlag = 32; // key frames only: the scale has a fourth quantum

/** The number in the header, also of an invalid frame; undefined if the header is incomplete. */
export function frameNumber(buffer: ArrayBuffer): number | undefined {
  if (buffer.byteLength < HeaderBytes.kBytes) return undefined;
  return new DataView(buffer).getUint32(12, true);
}

/** The header of a frame, followed by the scale of a key frame. */
export class HeaderBytes {
  static readonly kBytes = 52;
  private static readonly kKeyBytes = 108;
  private readonly view: DataView;

  /** @throws FrameError if the header is invalid. */
  constructor(buffer: ArrayBuffer) {
    this.view = new DataView(buffer);
    this.need(HeaderBytes.kBytes);
    this.checkKind();
    this.checkRules();
  }

  get isKey(): boolean {
    return this.view.getUint8(5) === 1;
  }

  get symbolsBegin(): number {
    if (!this.isKey) return HeaderBytes.kBytes;
    return HeaderBytes.kKeyBytes + (this.hasAcceleration ? 8 : 0);
  }

  get epoch(): number {
    return this.view.getUint32(8, true);
  }

  get number(): number {
    return this.view.getUint32(12, true);
  }

  get stride(): number {
    return this.view.getUint8(7);
  }

  /** The differences between the frame's number and those of its references; 0 if absent. */
  get distances(): [number, number] {
    return [this.view.getUint16(16, true), this.view.getUint16(18, true)];
  }

  get check(): number {
    return this.view.getUint32(20, true);
  }

  /** Reads the scale of a key frame. @throws FrameError if it is incomplete or invalid. */
  readScale(): FrameScale {
    this.need(this.symbolsBegin);
    const at = (k: number) => this.view.getFloat64(HeaderBytes.kBytes + 8 * k, true);
    const scale: FrameScale = {
      origin: [at(0), at(1), at(2)],
      quantum: at(3),
      attributeQuanta: [at(4), at(5), at(6), this.hasAcceleration ? at(7) : 0],
    };
    const numbers = [...scale.origin, scale.quantum, ...scale.attributeQuanta];
    const isGood =
      numbers.every(Number.isFinite) &&
      scale.quantum > 0 &&
      Math.min(...scale.attributeQuanta) >= 0 &&
      (!this.hasAcceleration || scale.attributeQuanta[3] > 0);
    if (!isGood) throw new FrameError('bad_header', 'the grid must be finite, its quanta above 0');
    return scale;
  }

  /** Writes all header fields. */
  write(into: FrameHeader, scale: FrameScale): void {
    const { view } = this;
    const flags = view.getUint8(6);
    into.playing = (flags & 1) !== 0;
    into.slow = (flags & 2) !== 0;
    into.detail = (flags >> 2) & 3;
    into.region = (flags & 16) !== 0;
    into.stride = this.stride;
    into.epoch = this.epoch;
    into.number = this.number;
    into.tick = view.getUint32(24, true) + 2 ** 32 * view.getUint32(28, true);
    into.time = view.getFloat64(32, true);
    into.published = view.getFloat64(40, true);
    into.realTimeFactor = view.getFloat32(48, true);
    Object.assign(into, scale);
  }

  private get hasAcceleration(): boolean {
    return (this.view.getUint8(6) & kAccelerationFlag) !== 0;
  }

  private checkKind(): void {
    const { view } = this;
    if (view.getUint32(0, true) !== kMagic) {
      throw new FrameError('bad_magic', 'the first four bytes are not "VATF"');
    }
    const version = view.getUint8(4);
    if (version !== kVersion) {
      throw new FrameError('bad_version', `version is ${version}, must be ${kVersion}`);
    }
    const type = view.getUint8(5);
    if (type !== 1 && type !== 2) {
      throw new FrameError('bad_type', `type ${type} is neither 1 nor 2`);
    }
  }

  private checkRules(): void {
    const { view } = this;
    const known = this.isKey ? kKnownFlags | kAccelerationFlag : kKnownFlags;
    if ((view.getUint8(6) & ~known) !== 0 || this.stride === 0) {
      throw new FrameError('bad_header', 'unused flags must be 0, and the stride above 0');
    }
    const isFinite =
      Number.isFinite(view.getFloat64(32, true)) &&
      Number.isFinite(view.getFloat64(40, true)) &&
      Number.isFinite(view.getFloat32(48, true));
    if (!isFinite) {
      throw new FrameError('bad_header', 'times and factor must be finite');
    }
    const [first, second] = this.distances;
    const areGood = this.isKey
      ? first === 0 && second === 0
      : first > 0 && (second === 0 || second > first);
    if (!areGood) throw new FrameError('bad_header', 'references must be earlier frames, in order');
  }

  private need(count: number): void {
    const { byteLength } = this.view;
    if (byteLength >= count) return;
    throw new FrameError('truncated', `the frame ends early: ${byteLength} of ${count} bytes`);
  }
}
