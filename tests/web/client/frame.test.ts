import { describe, expect, it, vi } from 'vitest';
import { BodyKind, emptyFrame, FrameDecoder, FrameError } from '../../../web/client/index';
import type { Frame, FrameBlock, FrameHeader } from '../../../web/client/index';
import {
  badFrames,
  damagedBytes,
  decoderAfter,
  goldenBytes,
  goldenFrame,
  goldenNames,
} from '../golden';
import type { GoldenBlock, GoldenFrame } from '../golden';

const kKindNames = ['liquid', 'deformable', 'rigid', 'vat'] as const;

/**
 * Converts a header to the members of the golden files, which contain accelerations if there are
 * any.
 */
function toGolden({ realTimeFactor, attributeQuanta, ...others }: FrameHeader): object {
  const attribute_quanta = attributeQuanta.slice(0, attributeQuanta[3] > 0 ? 4 : 3);
  return { ...others, real_time_factor: realTimeFactor, attribute_quanta };
}

/** Converts the integers of the golden file to numbers. */
function expectedBlock(block: GoldenBlock, { origin, quantum }: FrameHeader): object {
  const { body, place = [], orientation = [] } = block;
  const kind = kKindNames.indexOf(block.kind);
  if (kind === BodyKind.vat) return { kind, body, offset: place.map((step) => quantum * step) };
  if (kind === BodyKind.rigid) {
    const length = Math.sqrt(orientation.reduce((sum, part) => sum + part * part, 0));
    return {
      kind,
      body,
      position: place.map((step, axis) => (origin[axis] ?? 0) + (quantum / 2) * step),
      orientation: orientation.map((part) => part / length),
    };
  }
  return {
    kind,
    body,
    positions: block.grid_positions,
    numbers: block.numbers,
    attributes: [...(block.attributes ?? []), []].slice(0, 4),
  };
}

function plainBlock(block: FrameBlock): object {
  if (!('positions' in block)) return block;
  return {
    kind: block.kind,
    body: block.body,
    positions: [...block.positions],
    numbers: [...(block.numbers ?? block.positions.slice(0, block.positions.length / 3).keys())],
    attributes: block.attributes.map((column) => [...(column ?? [])]),
  };
}

function decode(name: string): { frame: Frame; golden: GoldenFrame } {
  const golden = goldenFrame(name);
  return { frame: decoderAfter(golden.after).decode(goldenBytes(name)), golden };
}

function refusal(decoder: FrameDecoder, bytes: ArrayBuffer): FrameError | undefined {
  try {
    decoder.decode(bytes);
    return undefined;
  } catch (error) {
    if (error instanceof FrameError) return error;
    throw error;
  }
}

describe('golden frames', () => {
  it('are there for each kind of body', () => {
    const kinds = goldenNames().flatMap((name) => goldenFrame(name).blocks.map(({ kind }) => kind));
    expect(new Set(kinds)).toEqual(new Set(kKindNames));
  });

  it.each(goldenNames())('%s decodes to its description', (name) => {
    const { frame, golden } = decode(name);
    expect(toGolden(frame.header)).toEqual(golden.header);
    expect(frame.blocks.map(plainBlock)).toEqual(
      golden.blocks.map((block) => expectedBlock(block, frame.header)),
    );
  });

  it.each(goldenNames())('%s is refused wherever it is cut off, and then taken', (name) => {
    const decoder = decoderAfter(goldenFrame(name).after);
    const bytes = goldenBytes(name);
    for (let length = 0; length < bytes.byteLength; ++length) {
      expect(refusal(decoder, bytes.slice(0, length))?.code).toBe('truncated');
    }
    expect(refusal(decoder, bytes)).toBeUndefined();
  });
});

describe('damaged frames', () => {
  it('are there', () => expect(badFrames().length).toBeGreaterThanOrEqual(30));

  it.each(badFrames())('$base with $name is refused as $error', (bad) => {
    expect(refusal(decoderAfter(bad.after), damagedBytes(bad))?.code).toBe(bad.error);
  });
});

it('counts the frames that were left out', () => {
  const decoder = decoderAfter(['v2-key']); // number 10
  expect(decoder.decode(goldenBytes('v2-delta-one')).dropped).toBe(1); // 12
  expect(decoder.decode(goldenBytes('v2-delta-two')).dropped).toBe(1); // 13
  expect(decoder.decode(goldenBytes('v2-dropped')).dropped).toBe(2); // 17, every second one
});

it('finds a reference before the numbers began again', () => {
  const numbered = (name: string, number: number): ArrayBuffer => {
    const bytes = goldenBytes(name);
    new DataView(bytes).setUint32(12, number, true);
    return bytes;
  };
  const decoder = new FrameDecoder();
  decoder.decode(numbered('v2-key', 0xffffffff));
  const frame = decoder.decode(numbered('v2-delta-one', 1)); // two further on
  expect(frame.header.number).toBe(1);
});

it('uses its memory again, and that of the frame which it is given', () => {
  const decoder = new FrameDecoder();
  const frame = emptyFrame();
  const bytes = ['v2-key', 'v2-delta-one', 'v2-delta-two'].map(goldenBytes);
  const cycle = () => bytes.forEach((buffer) => decoder.decode(buffer, frame));
  for (let i = 0; i < 17; ++i) cycle(); // each position of the ring has held each frame
  const { storage, blocks } = frame;
  let made = 0;
  for (const type of [ArrayBuffer, Uint16Array, Uint32Array, Int32Array]) {
    const construct = (target: typeof type, given: unknown[]): object => {
      if (typeof given[0] === 'number') ++made; // a new object, not a view of existing memory
      return Reflect.construct(target, given) as object;
    };
    vi.stubGlobal(type.name, new Proxy(type, { construct }));
  }
  try {
    for (let i = 0; i < 100; ++i) cycle();
  } finally {
    vi.unstubAllGlobals();
  }
  expect(made).toBe(0);
  expect(frame.storage).toBe(storage);
  expect(frame.blocks).toBe(blocks);
  for (const block of blocks)
    if ('positions' in block) expect(block.positions.buffer).toBe(storage);
});
