import type { BlockData } from './block_data.js';
import { BodyKind, kAttributes } from './block_data.js';
import type { FrameData } from './frame_ring.js';
import type { FrameHeader, FrameScale } from './header.js';
import { kGrowth } from './room.js';

/** Positions of a liquid or deformable body: x, y, z of each particle in quanta. */
export interface GridBlock {
  kind: typeof BodyKind.liquid | typeof BodyKind.deformable;
  body: number;
  positions: Uint16Array<ArrayBuffer>;
  /** Particle numbers, ascending; undefined: 0, 1, 2, ... */
  numbers: Uint32Array<ArrayBuffer> | undefined;
  /** Speed, density, pressure and acceleration in their quanta; undefined if absent. */
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

/** Displacement of the vat since time 0 [m]. */
export interface VatBlock {
  kind: typeof BodyKind.vat;
  body: 0;
  offset: [number, number, number];
}

export type FrameBlock = GridBlock | PoseBlock | VatBlock;

export interface Frame {
  header: FrameHeader;
  /** Number of frames that the server has omitted for this client. */
  dropped: number;
  blocks: FrameBlock[];
  /** The memory of all columns. Transferring it moves the frame to another thread. */
  storage: ArrayBuffer;
}

/** Returns a frame to decode to. It uses `storage` if it is large enough. */
export function emptyFrame(storage = new ArrayBuffer(0)): Frame {
  const header: FrameHeader = {
    playing: false,
    slow: false,
    detail: 0,
    region: false,
    epoch: 0,
    number: 0,
    stride: 1,
    tick: 0,
    time: 0,
    published: 0,
    realTimeFactor: 0,
    origin: [0, 0, 0],
    quantum: 1,
    attributeQuanta: [0, 0, 0, 0],
  };
  return { header, dropped: 0, blocks: [], storage };
}

/** Replaces the blocks of a frame. Allocates only if the existing memory is too small. */
export function writeBlocks(data: FrameData, frame: Frame): void {
  let bytes = 0;
  for (let b = 0; b < data.blockCount; ++b) bytes += bytesOf(data.block(b));
  if (frame.storage.byteLength < bytes) frame.storage = new ArrayBuffer(roundUp(kGrowth * bytes));
  frame.blocks.length = data.blockCount;
  let offset = 0;
  for (let b = 0; b < data.blockCount; ++b) {
    const block = data.block(b);
    frame.blocks[b] = written(block, frame.blocks[b], data.scale, frame.storage, offset);
    offset += bytesOf(block);
  }
}

function bytesOf({ count, isNumbered, hasAttribute }: BlockData): number {
  let columns = isNumbered ? 1 : 0;
  for (let q = 0; q < kAttributes; ++q) if (hasAttribute[q]) ++columns;
  return roundUp(6 * count) + 4 * columns * count;
}

function roundUp(bytes: number): number {
  return 4 * Math.ceil(bytes / 4);
}

function written(
  data: BlockData,
  old: FrameBlock | undefined,
  { origin, quantum }: FrameScale,
  storage: ArrayBuffer,
  offset: number,
): FrameBlock {
  const { kind, body, place } = data;
  if (kind === BodyKind.vat) {
    const block = old?.kind === kind ? old : vatBlock();
    for (let q = 0; q < 3; ++q) block.offset[q] = quantum * place[q]!;
    return block;
  }
  if (kind === BodyKind.rigid) {
    const block = old?.kind === kind ? old : poseBlock();
    block.body = body;
    for (let q = 0; q < 3; ++q) block.position[q] = origin[q]! + (quantum / 2) * place[q]!;
    const [w = 0, x = 0, y = 0, z = 0] = data.orientation;
    const length = Math.sqrt(w * w + x * x + y * y + z * z);
    for (let c = 0; c < 4; ++c) block.orientation[c] = data.orientation[c]! / length;
    return block;
  }
  const isSame = old?.kind === BodyKind.liquid || old?.kind === BodyKind.deformable;
  const block = isSame ? old : gridBlock();
  block.kind = kind;
  block.body = body;
  writeColumns(data, block, storage, offset);
  return block;
}

function writeColumns(data: BlockData, to: GridBlock, storage: ArrayBuffer, offset: number): void {
  const { count } = data;
  if (!isView(to.positions, storage, offset, 3 * count)) {
    to.positions = new Uint16Array(storage, offset, 3 * count);
  }
  to.positions.set(data.positions);
  offset += roundUp(6 * count);
  if (!data.isNumbered) to.numbers = undefined;
  else {
    if (!to.numbers || !isView(to.numbers, storage, offset, count)) {
      to.numbers = new Uint32Array(storage, offset, count);
    }
    to.numbers.set(data.numbers);
    offset += 4 * count;
  }
  for (let q = 0; q < kAttributes; ++q) {
    if (!data.hasAttribute[q]) {
      to.attributes[q] = undefined;
      continue;
    }
    let column = to.attributes[q];
    if (!column || !isView(column, storage, offset, count)) {
      column = new Int32Array(storage, offset, count);
      to.attributes[q] = column;
    }
    column.set(data.attribute(q));
    offset += 4 * count;
  }
}

function isView(
  view: ArrayBufferView,
  storage: ArrayBuffer,
  offset: number,
  length: number,
): boolean {
  const isThere = view.buffer === storage && view.byteOffset === offset;
  return isThere && (view as Uint16Array).length === length;
}

function vatBlock(): VatBlock {
  return { kind: BodyKind.vat, body: 0, offset: [0, 0, 0] };
}

function poseBlock(): PoseBlock {
  return { kind: BodyKind.rigid, body: 0, position: [0, 0, 0], orientation: [1, 0, 0, 0] };
}

function gridBlock(): GridBlock {
  const positions = new Uint16Array(0);
  return { kind: BodyKind.liquid, body: 0, positions, numbers: undefined, attributes: [] };
}
