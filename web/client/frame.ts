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
  epoch: number;
  sequence: number;
  tick: number;
  /** Simulation time [s]. */
  time: number;
  /** Server's clock when the state was published [s since 1970]. */
  published: number;
  /** Frames dropped for this client so far. */
  dropped: number;
  /** A position is origin + quantum * integer, per axis [m]. */
  origin: [number, number, number];
  quantum: number;
  /** Simulated seconds per second. */
  realTimeFactor: number;
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

const kHeaderBytes = 96;
const kBlockHeaderBytes = 12;
const kPoseBytes = 40;
const kOffsetBytes = 24;
const kMagic = 0x46544156; // "VATF", little-endian
const kKnownFlags = 0b11;
/** The encoding that belongs to each kind, by the kind's value. */
const kEncodings = [1, 1, 2, 3];
const kUnitTolerance = 1e-3;

/**
 * Decodes one key frame. Grid positions in the result share `buffer`.
 * @throws FrameError with the first reason, in the order of the bytes, why this is not one frame.
 */
export function decodeFrame(buffer: ArrayBuffer): Frame {
  const view = new DataView(buffer);
  needBytes(view, 0, kHeaderBytes);
  checkFixedFields(view);
  const header = readHeader(view);
  checkNumbers(header);
  const blockCount = view.getUint32(52, true);
  needBytes(view, kHeaderBytes, blockCount * kBlockHeaderBytes);
  const blocks: FrameBlock[] = [];
  let offset = kHeaderBytes;
  for (let i = 0; i < blockCount; ++i) {
    const block = readBlock(view, offset, i === 0);
    blocks.push(block);
    offset += blockBytes(block);
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
  if (version !== 1) throw new FrameError('bad_version', `version ${version} where 1 is known`);
  const type = view.getUint8(5);
  if (type !== 1) throw new FrameError('bad_type', `type ${type} where 1, a key frame, is known`);
  if ((view.getUint16(6, true) & ~kKnownFlags) !== 0 || view.getUint32(92, true) !== 0) {
    throw new FrameError('bad_header', 'unused flags and the reserved field must be 0');
  }
  if (view.getUint32(40, true) !== 0 || view.getUint32(44, true) !== 0) {
    throw new FrameError('bad_header', 'a key frame must have no references');
  }
}

function readHeader(view: DataView): FrameHeader {
  const flags = view.getUint16(6, true);
  return {
    playing: (flags & 1) !== 0,
    slow: (flags & 2) !== 0,
    epoch: view.getUint32(8, true),
    sequence: view.getUint32(12, true),
    tick: Number(view.getBigUint64(16, true)),
    time: view.getFloat64(24, true),
    published: view.getFloat64(32, true),
    dropped: view.getUint32(48, true),
    origin: readVector(view, 56),
    quantum: view.getFloat64(80, true),
    realTimeFactor: view.getFloat32(88, true),
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

function readBlock(view: DataView, offset: number, first: boolean): FrameBlock {
  needBytes(view, offset, kBlockHeaderBytes);
  const body = view.getUint32(offset, true);
  const kind = view.getUint8(offset + 4);
  const count = view.getUint32(offset + 8, true);
  checkBlockHeader(view, offset, first);
  const data = offset + kBlockHeaderBytes;
  switch (kind) {
    case BodyKind.rigid:
      return { kind, body, ...readPose(view, data) };
    case BodyKind.vat:
      return { kind, body: 0, offset: readPosition(view, data, kOffsetBytes) };
    default:
      needBytes(view, data, 6 * count);
      return { kind: kind as GridBlock['kind'], body, positions: gridView(view, data, 3 * count) };
  }
}

function checkBlockHeader(view: DataView, offset: number, first: boolean): void {
  const kind = view.getUint8(offset + 4);
  const isVat = kind === BodyKind.vat;
  const hasParticles = kind === BodyKind.liquid || kind === BodyKind.deformable;
  if (kind >= kEncodings.length) badBlock('its kind must be from 0 to 3');
  if (view.getUint8(offset + 5) !== kEncodings[kind]) badBlock('its encoding must fit its kind');
  if (view.getUint16(offset + 6, true) !== 0) badBlock('its reserved field must be 0');
  if (!hasParticles && view.getUint32(offset + 8, true) !== 0) badBlock('it has no particles');
  if (isVat !== (view.getUint32(offset, true) === 0)) badBlock('body 0 must be the vat');
  if (isVat && !first) badBlock('the vat must come first');
}

function badBlock(reason: string): never {
  throw new FrameError('bad_block', `a block is wrong: ${reason}`);
}

/** Every part of a frame has an even length, so the view is aligned. */
function gridView(view: DataView, offset: number, length: number): GridBlock['positions'] {
  return new Uint16Array(view.buffer as ArrayBuffer, offset, length);
}

function readPose(view: DataView, offset: number): Pick<PoseBlock, 'position' | 'orientation'> {
  const position = readPosition(view, offset, kPoseBytes);
  const orientation: PoseBlock['orientation'] = [
    view.getFloat32(offset + 24, true),
    view.getFloat32(offset + 28, true),
    view.getFloat32(offset + 32, true),
    view.getFloat32(offset + 36, true),
  ];
  const square = orientation.reduce((sum, component) => sum + component * component, 0);
  if (!(Math.abs(square - 1) <= kUnitTolerance)) badBlock('its orientation must have length 1');
  return { position, orientation };
}

/** The vector with which `bytes` bytes begin. */
function readPosition(view: DataView, offset: number, bytes: number): [number, number, number] {
  needBytes(view, offset, bytes);
  const position = readVector(view, offset);
  if (!position.every(Number.isFinite)) badBlock('its position must be finite');
  return position;
}

function readVector(view: DataView, offset: number): [number, number, number] {
  return [
    view.getFloat64(offset, true),
    view.getFloat64(offset + 8, true),
    view.getFloat64(offset + 16, true),
  ];
}

function needBytes(view: DataView, offset: number, count: number): void {
  const left = view.byteLength - offset;
  if (left < count) {
    throw new FrameError('truncated', `the frame ends early: ${left} bytes where ${count} are due`);
  }
}

function blockBytes(block: FrameBlock): number {
  switch (block.kind) {
    case BodyKind.rigid:
      return kBlockHeaderBytes + kPoseBytes;
    case BodyKind.vat:
      return kBlockHeaderBytes + kOffsetBytes;
    default:
      return kBlockHeaderBytes + block.positions.byteLength;
  }
}
