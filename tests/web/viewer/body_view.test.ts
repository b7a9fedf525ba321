import { Ray, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { BodyKind } from '../../../web/client/index';
import type { FrameHeader, GridBlock } from '../../../web/client/index';
import { lookOf } from '../../../web/viewer/view/base/appearance';
import { BodyView } from '../../../web/viewer/view/bodies/body_view';
import { Workshop } from '../../../web/viewer/view/surface/workshop';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';

const header = { origin: [0, 0, 0], quantum: 1 } as unknown as FrameHeader;

/** Particles along x, ten units apart. */
function block(count: number): GridBlock {
  const positions = new Uint16Array(3 * count);
  for (let i = 0; i < count; ++i) positions[3 * i] = 10 * i;
  return { kind: BodyKind.liquid, body: 1, positions, numbers: undefined, attributes: [] };
}

function liquid(particles: number): BodyView {
  const description = {
    body: 1,
    name: 'pool',
    kind: 'liquid' as const,
    material: 'water',
    particles,
    radius: 1,
  };
  return new BodyView(
    description,
    0,
    lookOf(undefined),
    sharedUniforms(),
    new Workshop(),
    () => undefined,
  );
}

/** Returns the particle at 10 i, seen from above. */
function pickAt(view: BodyView, i: number): number | undefined {
  return view.pick(new Ray(new Vector3(10 * i, 0, 50), new Vector3(0, 0, -1)))?.particle;
}

/** Returns the particle numbers in the attributes of the graphics. */
function numbersOf(view: BodyView): { shown: number[]; version: number } {
  const { image, version } = view.columns.uniforms.name_texels.value;
  const shown = Array.from({ length: view.count }, (_, i) => image.data![2 * i]!);
  return { shown, version };
}

describe('BodyView', () => {
  it('shows as many particles as a frame has, whatever was described', () => {
    const view = liquid(4);
    for (const count of [4, 9, 3, 9, 40, 0, 1]) {
      view.showGrid(block(count), header);
      expect(view.count).toBe(count);
      if (count > 0) {
        expect(pickAt(view, count - 1)).toBe(count - 1);
        expect(view.positionOf(count - 1)?.x).toBe(10 * (count - 1));
      }
      expect(pickAt(view, count)).toBeUndefined();
    }
  });

  it('names particles by their numbers if some are missing', () => {
    const view = liquid(4);
    view.showGrid({ ...block(3), numbers: Uint32Array.of(1, 4, 9) }, header);
    expect(pickAt(view, 2)).toBe(9);
    expect(view.positionOf(4)?.x).toBe(10);
    expect(view.positionOf(2)).toBeUndefined();
    expect(view.positionOf(10)).toBeUndefined();
  });

  it('tints particles by their numbers, which it sends only when they change', () => {
    const view = liquid(4);
    view.showGrid(block(4), header);
    expect(numbersOf(view).shown).toEqual([0, 1, 2, 3]);
    const first = numbersOf(view).version;
    const numbers = Uint32Array.of(1, 4, 9);
    view.showGrid({ ...block(3), numbers }, header);
    const { shown, version } = numbersOf(view);
    expect(shown).toEqual([1, 4, 9]);
    expect(version).toBeGreaterThan(first);
    view.showGrid({ ...block(3), numbers: numbers.slice() }, header);
    expect(numbersOf(view).version).toBe(version);
    view.showGrid({ ...block(5), numbers: Uint32Array.of(1, 4, 9, 10, 12) }, header);
    expect(numbersOf(view).shown).toEqual([1, 4, 9, 10, 12]);
    view.showGrid(block(2), header);
    expect(numbersOf(view).shown).toEqual([0, 1]);
  });
});
