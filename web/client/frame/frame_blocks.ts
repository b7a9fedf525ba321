import type { BlockData } from './block_data.js';
import { BodyKind } from './block_data.js';
import { ParticleChanges, readFactor } from './changes.js';
import { badBlock } from './frame_error.js';
import type { FrameData } from './frame_ring.js';
import type { FrameScale } from './header.js';
import type { SymbolReader } from './symbols.js';

const kMostPlace = 2 ** 28;
/** Probabilities, of 4096, that a block has changed, if the previous block is unchanged or changed. */
const kAfterUnchanged = 256;
const kAfterChanged = 3584;

/** Reads the blocks of a frame: protocol/FRAMES.md, "Blocks". */
export class FrameBlocks {
  private readonly changes: ParticleChanges;

  constructor(private readonly symbols: SymbolReader) {
    this.changes = new ParticleChanges(symbols);
  }

  readKey(frame: FrameData): void {
    const count = this.symbols.whole();
    if (!this.symbols.mayHold(count)) badBlock('there are too few bytes for them');
    frame.resize(count);
    for (let b = 0; b < count; ++b) {
      const block = frame.block(b);
      block.body = this.symbols.whole();
      block.kind = this.symbols.bits(2) as BodyKind;
      block.hasAttribute = attributesOf(block.kind, frame.scale);
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

  readDelta(frame: FrameData, first: FrameData, second: FrameData | undefined): void {
    const turn = readFactor(this.symbols);
    frame.resize(first.blockCount);
    let isChanged = false;
    for (let b = 0; b < frame.blockCount; ++b) {
      const block = frame.block(b);
      const old = first.block(b);
      isChanged = this.symbols.flag(isChanged ? kAfterChanged : kAfterUnchanged);
      if (!isChanged) {
        block.copy(old);
        continue;
      }
      block.body = old.body;
      block.kind = old.kind;
      block.hasAttribute = old.hasAttribute;
      if (block.hasParticles) this.changes.read(old, second?.block(b), block);
      else this.readPoseChange(block, old, second?.block(b) ?? old, turn);
    }
  }

  private readParticles(block: BlockData): void {
    const { symbols } = this;
    const { added } = this.changes;
    const count = symbols.whole();
    if (!symbols.mayHold(count)) badBlock('it has too few bytes for its particles');
    const isPlain = symbols.flag(2048);
    added.reserve(count);
    if (!isPlain) added.readNumbers(symbols, added.numbers);
    block.resize(count, isPlain ? undefined : added.numbers);
    for (let i = 0; i < count; ++i) added.places[i] = i;
    added.read(symbols, block);
  }

  private readPose(block: BlockData): void {
    block.resize(0);
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

  private readPoseChange(
    block: BlockData,
    first: BlockData,
    second: BlockData,
    turn: number,
  ): void {
    block.resize(0);
    block.orientationBits = first.orientationBits;
    this.readNear(block.place, first.place, second.place, turn);
    block.orientation.fill(0);
    if (block.kind === BodyKind.vat) return;
    this.readNear(block.orientation, first.orientation, second.orientation, turn);
    checkOrientation(block);
  }

  private readNear(to: Int32Array, first: Int32Array, second: Int32Array, turn: number): void {
    const residualClass = this.symbols.residualClass();
    for (let c = 0; c < to.length; ++c) {
      const here = first[c]!;
      const ahead = here + Math.floor((turn * (here - second[c]!) + 128) / 256);
      const expected = Math.min(Math.max(ahead, -kMostPlace), kMostPlace);
      const value = expected + this.symbols.residual(residualClass, 0, c % 3);
      if (Math.abs(value) > kMostPlace) badBlock('a place is too far away');
      to[c] = value;
    }
  }
}

const kOfDeformable: readonly number[] = [0, 3]; // speed and acceleration

function attributesOf(kind: BodyKind, { attributeQuanta }: FrameScale): boolean[] {
  return attributeQuanta.map(
    (quantum, q) =>
      quantum > 0 &&
      (kind === BodyKind.liquid || (kind === BodyKind.deformable && kOfDeformable.includes(q))),
  );
}

function checkOrientation({ orientation, orientationBits }: BlockData): void {
  let square = 0;
  for (let c = 0; c < 4; ++c) square += orientation[c]! * orientation[c]!;
  const part = square / 4 ** orientationBits;
  if (part < 0.75 || part > 1.25) badBlock('its orientation must have length 1');
}
