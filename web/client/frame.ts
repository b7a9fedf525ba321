/**
 * Decoder of the binary frames of protocol/PROTOCOL.md, "Frames". A frame's positions are copies of
 * their own, so that it can be handed to another thread by transferring its buffers; all else keeps
 * its memory from frame to frame.
 */
import { BlockData, BodyKind, kAttributes } from './frame/block_data';
import { ParticleChanges, readFactor } from './frame/changes';
import { FrameError } from './frame/frame_error';
import { badBlock, SymbolReader } from './frame/symbols';

export { BodyKind } from './frame/block_data';
export { FrameError } from './frame/frame_error';
export type { FrameErrorCode } from './frame/frame_error';

export interface FrameHeader {
  playing: boolean;
  /** The session runs slower than its set speed. */
  slow: boolean;
  /** Level of detail, 0 to 3, and whether there is more beyond a region. */
  detail: number;
  region: boolean;
  epoch: number;
  /** Counts the session's frames that show something new. */
  number: number;
  /** This client gets every stride-th number. */
  stride: number;
  tick: number;
  /** Simulation time [s]. */
  time: number;
  /** Server's clock when the state was published [s since 1970]. */
  published: number;
  /** Simulated seconds per second. */
  realTimeFactor: number;
  /** A position is origin + quantum * integer, per axis [m]. */
  origin: [number, number, number];
  quantum: number;
  /** Steps of speed [m/s], density [kg/m^3] and pressure [Pa]; 0 where a frame has none. */
  attributeQuanta: [number, number, number];
}

/** Positions of a liquid or deformable body: x, y, z of each particle in grid steps. */
export interface GridBlock {
  kind: typeof BodyKind.liquid | typeof BodyKind.deformable;
  body: number;
  positions: Uint16Array<ArrayBuffer>;
  /** Of the particles, rising; undefined: 0, 1, 2, ... */
  numbers: Uint32Array<ArrayBuffer> | undefined;
  /** Speed, density and pressure in their quanta; undefined where the block has none. */
  attributes: (Int32Array<ArrayBuffer> | undefined)[];
}

/** Pose of a rigid body. */
export interface PoseBlock {
  kind: typeof BodyKind.rigid;
  body: number;
  /** Centre of mass [m]. */
  position: [number, number, number];
  /** Quaternion w, x, y, z. */
  orientation: [number, number, number, number];
}

/** Displacement of the vat from its place at time 0 [m]. */
export interface VatBlock {
  kind: typeof BodyKind.vat;
  body: 0;
  offset: [number, number, number];
}

export type FrameBlock = GridBlock | PoseBlock | VatBlock;

export interface Frame {
  header: FrameHeader;
  /** Frames that the server left out for this client so far. */
  dropped: number;
  blocks: FrameBlock[];
}

const kHeaderBytes = 52;
const kScaleBytes = 56;
const kMagic = 0x46544156; // "VATF", little-endian
const kKnownFlags = 31;
const kRing = 16;
const kMostPlace = 2 ** 28;
/** Out of 4096, that a block has changed: where the one before has not, and where it has. */
const kChangeChances = [256, 3584] as const;

/** A frame that later ones may build on. */
class FrameData {
  header: FrameHeader | undefined;
  readonly blocks: BlockData[] = [];
  blockCount = 0;

  resize(count: number): void {
    this.blockCount = count;
    while (this.blocks.length < count) this.blocks.push(new BlockData());
  }

  block(index: number): BlockData {
    return this.blocks[index] as BlockData;
  }
}

/** Decodes the frames of one connection in their order. */
export class FrameDecoder {
  private readonly ring = Array.from({ length: kRing + 1 }, () => new FrameData());
  private next = 0;
  /** Of those before `next`, so many may be referred to. */
  private known = 0;
  private last = 0;
  private dropped = 0;
  private readonly symbols = new SymbolReader();
  private readonly changes = new ParticleChanges();

  /** @throws FrameError with the first reason why this is no frame; it then changes nothing. */
  decode(buffer: ArrayBuffer): Frame {
    const view = new DataView(buffer);
    const header = readHeader(view);
    const isKey = view.getUint8(5) === 1;
    const frame = this.ring[this.next] as FrameData;
    let begin = kHeaderBytes;
    let first: FrameData | undefined;
    let second: FrameData | undefined;
    if (isKey) {
      readScale(view, header);
      begin += kScaleBytes;
    } else {
      first = this.find(header, view.getUint16(16, true));
      second =
        view.getUint16(18, true) === 0 ? undefined : this.find(header, view.getUint16(18, true));
      header.origin = first.header?.origin ?? header.origin;
      header.quantum = first.header?.quantum ?? header.quantum;
      header.attributeQuanta = first.header?.attributeQuanta ?? header.attributeQuanta;
    }
    this.symbols.start(new Uint8Array(buffer), begin);
    if (first) this.readDeltaBlocks(frame, first, second);
    else this.readKeyBlocks(frame, header);
    this.symbols.end();
    let check = 0;
    for (let b = 0; b < frame.blockCount; ++b) check = frame.block(b).addTo(check);
    if (check >>> 0 !== view.getUint32(20, true)) {
      throw new FrameError('bad_check', 'the frame is not the one that was encoded');
    }
    frame.header = header;
    this.known = isKey ? 1 : Math.min(this.known + 1, kRing);
    this.next = (this.next + 1) % this.ring.length;
    this.countDropped(header);
    return { header, dropped: this.dropped, blocks: blocksOf(frame, header) };
  }

  private countDropped({ number, stride }: FrameHeader): void {
    if (this.last > 0 && number > this.last) {
      this.dropped += Math.max(0, Math.round((number - this.last) / stride) - 1);
    }
    this.last = number;
  }

  private find({ number, epoch }: FrameHeader, distance: number): FrameData {
    for (let back = 1; back <= this.known; ++back) {
      const frame = this.ring[(this.next + this.ring.length - back) % this.ring.length];
      if (frame?.header?.number === number - distance && frame.header.epoch === epoch) return frame;
    }
    throw new FrameError('missing_reference', `frame ${number - distance} is not there`);
  }

  private readKeyBlocks(frame: FrameData, header: FrameHeader): void {
    const count = this.symbols.whole();
    if (!this.symbols.mayHold(count)) badBlock('there are too few bytes for them');
    frame.resize(count);
    for (let b = 0; b < count; ++b) {
      const block = frame.block(b);
      block.body = this.symbols.whole();
      block.kind = this.symbols.bits(2) as BodyKind;
      block.hasAttribute = attributesOf(block.kind, header);
      if (block.hasParticles) this.readParticles(block);
      else this.readPose(block);
    }
    for (let b = 0; b < count; ++b) {
      const { kind, body } = frame.block(b);
      const isVat = kind === BodyKind.vat;
      if (isVat !== (body === 0)) badBlock('body 0 must be the vat');
      if (isVat && b > 0) badBlock('the vat must come first');
    }
  }

  private readParticles(block: BlockData): void {
    const { symbols } = this;
    const { added } = this.changes;
    const count = symbols.whole();
    if (!symbols.mayHold(count)) badBlock('it has too few bytes for its particles');
    const isPlain = symbols.flag(2048);
    added.reserve(count);
    block.resize(count);
    block.isNumbered = false;
    if (!isPlain) {
      block.resizeNumbers(count);
      added.readNumbers(symbols, block.numbers);
      block.isNumbered = count > 0 && block.numbers[count - 1] !== count - 1;
    }
    for (let i = 0; i < count; ++i) added.places[i] = i;
    added.read(symbols, block);
  }

  private readPose(block: BlockData): void {
    block.count = 0;
    block.orientationBits = 0;
    block.orientation.fill(0);
    for (let q = 0; q < 3; ++q) block.place[q] = this.readSigned();
    if (block.kind === BodyKind.vat) return;
    block.orientationBits = this.symbols.bits(5);
    for (let q = 0; q < 4; ++q) block.orientation[q] = this.readSigned();
    checkOrientation(block);
  }

  private readSigned(): number {
    const coded = this.symbols.whole();
    const half = Math.floor(coded / 2);
    if (half > kMostPlace) badBlock('a place is too far away');
    return coded % 2 === 1 ? -half : half;
  }

  private readDeltaBlocks(frame: FrameData, first: FrameData, second?: FrameData): void {
    const turn = readFactor(this.symbols);
    frame.resize(first.blockCount);
    let before = false;
    for (let b = 0; b < frame.blockCount; ++b) {
      const block = frame.block(b);
      const old = first.block(b);
      before = this.symbols.flag(kChangeChances[before ? 1 : 0]);
      if (!before) {
        block.copy(old);
        continue;
      }
      block.body = old.body;
      block.kind = old.kind;
      block.hasAttribute = old.hasAttribute;
      if (block.hasParticles) this.changes.read(this.symbols, old, second?.block(b), block);
      else this.readPoseChange(block, old, second?.block(b) ?? old, turn);
    }
  }

  private readPoseChange(
    block: BlockData,
    first: BlockData,
    second: BlockData,
    turn: number,
  ): void {
    block.count = 0;
    block.orientationBits = first.orientationBits;
    this.readNear(block.place, first.place, second.place, turn);
    if (block.kind === BodyKind.vat) return;
    this.readNear(block.orientation, first.orientation, second.orientation, turn);
    checkOrientation(block);
  }

  private readNear(to: Int32Array, first: Int32Array, second: Int32Array, turn: number): void {
    const residualClass = this.symbols.residualClass();
    for (let c = 0; c < to.length; ++c) {
      const here = first[c] as number;
      const step = here - (second[c] as number);
      const ahead = here + Math.floor((turn * step + 128) / 256);
      const expected = Math.min(Math.max(ahead, -kMostPlace), kMostPlace);
      const value = expected + this.symbols.residual(residualClass, 0, c % 3);
      if (Math.abs(value) > kMostPlace) badBlock('a place is too far away');
      to[c] = value;
    }
  }
}

function readHeader(view: DataView): FrameHeader {
  needBytes(view, kHeaderBytes);
  if (view.getUint32(0, true) !== kMagic) {
    throw new FrameError('bad_magic', 'the first four bytes are not "VATF"');
  }
  const version = view.getUint8(4);
  if (version !== 2) throw new FrameError('bad_version', `version ${version} where 2 is known`);
  const type = view.getUint8(5);
  if (type !== 1 && type !== 2) throw new FrameError('bad_type', `type ${type} is neither 1 nor 2`);
  const flags = view.getUint8(6);
  const header: FrameHeader = {
    playing: (flags & 1) !== 0,
    slow: (flags & 2) !== 0,
    detail: (flags >> 2) & 3,
    region: (flags & 16) !== 0,
    stride: view.getUint8(7),
    epoch: view.getUint32(8, true),
    number: view.getUint32(12, true),
    tick: Number(view.getBigUint64(24, true)),
    time: view.getFloat64(32, true),
    published: view.getFloat64(40, true),
    realTimeFactor: view.getFloat32(48, true),
    origin: [0, 0, 0],
    quantum: 1,
    attributeQuanta: [0, 0, 0],
  };
  if ((flags & ~kKnownFlags) !== 0 || header.stride === 0) {
    throw new FrameError('bad_header', 'unused flags must be 0, and the stride above 0');
  }
  if (![header.time, header.published, header.realTimeFactor].every(Number.isFinite)) {
    throw new FrameError('bad_header', 'times and factor must be finite');
  }
  const first = view.getUint16(16, true);
  const second = view.getUint16(18, true);
  const areGood =
    type === 1 ? first === 0 && second === 0 : first > 0 && (second === 0 || second > first);
  if (!areGood) throw new FrameError('bad_header', 'references must be earlier frames, in order');
  return header;
}

function readScale(view: DataView, header: FrameHeader): void {
  needBytes(view, kHeaderBytes + kScaleBytes);
  const numbers = Array.from({ length: 7 }, (_, k) => view.getFloat64(kHeaderBytes + 8 * k, true));
  const [x = 0, y = 0, z = 0, quantum = 0, speed = 0, density = 0, pressure = 0] = numbers;
  if (!numbers.every(Number.isFinite) || quantum <= 0 || Math.min(speed, density, pressure) < 0) {
    throw new FrameError('bad_header', 'the grid must be finite, and its quanta above 0');
  }
  header.origin = [x, y, z];
  header.quantum = quantum;
  header.attributeQuanta = [speed, density, pressure];
}

function attributesOf(kind: BodyKind, { attributeQuanta }: FrameHeader): boolean[] {
  return attributeQuanta.map(
    (quantum, q) =>
      quantum > 0 && (kind === BodyKind.liquid || (kind === BodyKind.deformable && q === 0)),
  );
}

function checkOrientation({ orientation, orientationBits }: BlockData): void {
  const square = orientation.reduce((sum, component) => sum + component * component, 0);
  const part = square / 4 ** orientationBits;
  if (part < 0.75 || part > 1.25) badBlock('its orientation must have length 1');
}

function blocksOf(frame: FrameData, { origin, quantum }: FrameHeader): FrameBlock[] {
  return frame.blocks.slice(0, frame.blockCount).map((block): FrameBlock => {
    const { kind, body, place, count } = block;
    const [x = 0, y = 0, z = 0] = place;
    if (kind === BodyKind.vat) {
      return { kind, body: 0, offset: [quantum * x, quantum * y, quantum * z] };
    }
    if (kind === BodyKind.rigid) {
      const step = quantum / 2;
      const position: PoseBlock['position'] = [
        origin[0] + step * x,
        origin[1] + step * y,
        origin[2] + step * z,
      ];
      return { kind, body, position, orientation: unit(block.orientation) };
    }
    return {
      kind,
      body,
      positions: block.positions.slice(0, 3 * count),
      numbers: block.isNumbered ? block.numbers.slice(0, count) : undefined,
      attributes: Array.from({ length: kAttributes }, (_, q) =>
        block.hasAttribute[q] ? block.attribute(q).slice(0, count) : undefined,
      ),
    };
  });
}

function unit([w = 0, x = 0, y = 0, z = 0]: Int32Array): PoseBlock['orientation'] {
  const length = Math.sqrt(w * w + x * x + y * y + z * z);
  return [w / length, x / length, y / length, z / length];
}

function needBytes(view: DataView, count: number): void {
  if (view.byteLength >= count) return;
  throw new FrameError('truncated', `the frame ends early: ${view.byteLength} of ${count} bytes`);
}
