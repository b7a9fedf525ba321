import { describe, expect, it } from 'vitest';
import { BodyKind, decodeFrame, FrameError } from '../../web/client/index';
import type { Frame, FrameBlock } from '../../web/client/index';
import { badFrames, damagedBytes, goldenBytes, goldenFrame, goldenNames } from './golden';
import type { GoldenBlock, GoldenFrame } from './golden';

const kKindNames = ['liquid', 'deformable', 'rigid', 'vat'] as const;

/** A decoded frame in the words of the golden files. */
function toGolden({ header, blocks }: Frame): GoldenFrame {
  const { realTimeFactor, ...others } = header;
  return {
    header: { ...others, real_time_factor: realTimeFactor },
    blocks: blocks.map(blockToGolden),
  };
}

function blockToGolden(block: FrameBlock): GoldenBlock {
  const named = { body: block.body, kind: kKindNames[block.kind] };
  switch (block.kind) {
    case BodyKind.vat:
      return { ...named, position: block.offset };
    case BodyKind.rigid:
      return { ...named, position: block.position, orientation: block.orientation };
    default:
      return { ...named, grid_positions: [...block.positions] };
  }
}

function refusal(bytes: ArrayBuffer): FrameError | undefined {
  try {
    decodeFrame(bytes);
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
    expect(toGolden(decodeFrame(goldenBytes(name)))).toEqual(goldenFrame(name));
  });

  it.each(goldenNames())('%s is refused wherever it is cut off', (name) => {
    const bytes = goldenBytes(name);
    for (let length = 0; length < bytes.byteLength; ++length) {
      expect(refusal(bytes.slice(0, length))?.code).toBe('truncated');
    }
  });
});

describe('damaged frames', () => {
  it('are there', () => expect(badFrames().length).toBeGreaterThanOrEqual(30));

  it.each(badFrames())('$base with $name is refused as $error', (bad) => {
    expect(refusal(damagedBytes(bad))?.code).toBe(bad.error);
  });

  it('is refused before anything is allocated for its particle count', () => {
    const bytes = goldenBytes('v1-liquid');
    const first = new DataView(bytes);
    const isVat = first.getUint8(96 + 4) === BodyKind.vat;
    first.setUint32((isVat ? 96 + 36 : 96) + 8, 0xffffffff, true);
    expect(refusal(bytes)?.code).toBe('truncated');
  });
});

it('gives positions as views of the received bytes', () => {
  const bytes = goldenBytes('v1-all');
  const grids = decodeFrame(bytes).blocks.filter((block) => 'positions' in block);
  expect(grids).toHaveLength(2);
  for (const { positions } of grids) expect(positions.buffer).toBe(bytes);
});
