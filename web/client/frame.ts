/**
 * Decoder of the binary frames of protocol/PROTOCOL.md, "Frames". It makes no object per particle:
 * grid positions are views of the received buffer, so that a frame can be handed to another thread
 * by transferring that one buffer.
 */

/** What a block is about; the values are those on the wire. */
export const BodyKind = { liquid: 0, deformable: 1, rigid: 2, vat: 3 } as const;
export type BodyKind = (typeof BodyKind)[keyof typeof BodyKind];

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
}

/** Positions of a liquid or deformable body: x, y, z of each particle in grid steps. */
export interface GridBlock {
  kind: typeof BodyKind.liquid | typeof BodyKind.deformable;
  body: number;
  positions: Uint16Array<ArrayBuffer>;
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

export type FrameErrorCode =
  | 'bad_magic'
  | 'bad_version'
  | 'bad_type'
  | 'bad_header'
  | 'bad_block'
  | 'truncated'
  | 'extra_bytes';

/** Why bytes are not a frame. */
export class FrameError extends Error {
  constructor(
    readonly code: FrameErrorCode,
    message: string,
  ) {
    super(message);
    this.name = 'FrameError';
  }
}

const kHeaderBytes = 108;
const kBlockHeaderBytes = 12;
const kMagic = 0x46544156; // "VATF", little-endian
const kKnownFlags = 31;

/** Decodes the frames of one connection in their order. */
export class FrameDecoder {
  private last = 0;
  private dropped = 0;

  /** @throws FrameError as decodeFrame() */
  decode(buffer: ArrayBuffer): Frame {
    const frame = decodeFrame(buffer);
    const { number, stride } = frame.header;
    if (this.last > 0 && number > this.last) {
      this.dropped += Math.max(0, Math.round((number - this.last) / stride) - 1);
    }
    this.last = number;
    return { ...frame, dropped: this.dropped };
  }
}

/**
 * Decodes one key frame.
 * @throws FrameError with the first reason, in the order of the bytes, why this is not one frame.
 */
export function decodeFrame(buffer: ArrayBuffer): Omit<Frame, 'dropped'> {
  const view = new DataView(buffer);
  needBytes(view, 0, kHeaderBytes + 4);
  checkFixedFields(view);
  const header = readHeader(view);
  checkNumbers(header);
  const blockCount = view.getUint32(kHeaderBytes, true);
  let offset = kHeaderBytes + 4;
  needBytes(view, offset, blockCount * kBlockHeaderBytes);
  const blocks: FrameBlock[] = [];
  for (let i = 0; i < blockCount; ++i) {
    const [block, end] = readBlock(view, offset, i === 0, header);
    blocks.push(block);
    offset = end;
  }
  if (offset !== view.byteLength) {
    throw new FrameError('extra_bytes', `${view.byteLength - offset} bytes after the last block`);
  }
  return { header, blocks };
}

function checkFixedFields(view: DataView): void {
  if (view.getUint32(0, true) !== kMagic) {
    throw new FrameError('bad_magic', 'the first four bytes are not "VATF"');
  }
  const version = view.getUint8(4);
  if (version !== 2) throw new FrameError('bad_version', `version ${version} where 2 is known`);
  const type = view.getUint8(5);
  if (type !== 1) throw new FrameError('bad_type', `type ${type} where 1, a key frame, is known`);
  if ((view.getUint8(6) & ~kKnownFlags) !== 0 || view.getUint8(7) === 0) {
    throw new FrameError('bad_header', 'unused flags must be 0, and the stride above 0');
  }
  if (view.getUint32(16, true) !== 0) {
    throw new FrameError('bad_header', 'a key frame must have no references');
  }
}

function readHeader(view: DataView): FrameHeader {
  const flags = view.getUint8(6);
  return {
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
    origin: [view.getFloat64(52, true), view.getFloat64(60, true), view.getFloat64(68, true)],
    quantum: view.getFloat64(76, true),
  };
}

function checkNumbers({ time, published, realTimeFactor, origin, quantum }: FrameHeader): void {
  if (![time, published, realTimeFactor, ...origin].every(Number.isFinite)) {
    throw new FrameError('bad_header', 'times, factor and grid origin must be finite');
  }
  if (!Number.isFinite(quantum) || quantum <= 0) {
    throw new FrameError('bad_header', 'the quantum must be finite and above 0');
  }
}

/** The block, and the offset behind it. */
function readBlock(
  view: DataView,
  offset: number,
  first: boolean,
  header: FrameHeader,
): [FrameBlock, number] {
  needBytes(view, offset, kBlockHeaderBytes);
  const body = view.getUint32(offset, true);
  const kind = view.getUint8(offset + 4);
  const numbered = view.getUint16(offset + 6, true);
  const count = view.getUint32(offset + 8, true);
  const isVat = kind === BodyKind.vat;
  if (kind > BodyKind.vat) badBlock('its kind must be from 0 to 3');
  if (isVat !== (body === 0)) badBlock('body 0 must be the vat');
  if (isVat && !first) badBlock('the vat must come first');
  const data = offset + kBlockHeaderBytes;
  if (isVat) {
    needBytes(view, data, 12);
    return [{ kind, body: 0, offset: readPlace(view, data, [0, 0, 0], header.quantum) }, data + 12];
  }
  if (kind === BodyKind.rigid) {
    needBytes(view, data, 28);
    const position = readPlace(view, data, header.origin, header.quantum / 2);
    return [{ kind, body, position, orientation: readOrientation(view, data + 12) }, data + 28];
  }
  const places = data + (numbered ? 4 * count : 0);
  needBytes(view, places, 6 * count);
  const positions = new Uint16Array(3 * count);
  for (let i = 0; i < positions.length; ++i) positions[i] = view.getUint16(places + 2 * i, true);
  return [{ kind: kind as GridBlock['kind'], body, positions }, places + 6 * count];
}

function badBlock(reason: string): never {
  throw new FrameError('bad_block', `a block is wrong: ${reason}`);
}

type Vector = [number, number, number];

function readPlace(view: DataView, offset: number, [x, y, z]: Vector, step: number): Vector {
  return [
    x + step * view.getInt32(offset, true),
    y + step * view.getInt32(offset + 4, true),
    z + step * view.getInt32(offset + 8, true),
  ];
}

function readOrientation(view: DataView, offset: number): PoseBlock['orientation'] {
  const w = view.getInt32(offset, true);
  const x = view.getInt32(offset + 4, true);
  const y = view.getInt32(offset + 8, true);
  const z = view.getInt32(offset + 12, true);
  const length = Math.hypot(w, x, y, z);
  return [w / length, x / length, y / length, z / length];
}

function needBytes(view: DataView, offset: number, count: number): void {
  const left = view.byteLength - offset;
  if (left < count) {
    throw new FrameError('truncated', `the frame ends early: ${left} bytes where ${count} are due`);
  }
}
