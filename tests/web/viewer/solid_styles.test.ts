import { Box3, Ray, Vector3 } from 'three';
import type { Mesh } from 'three';
import { describe, expect, it } from 'vitest';
import { BodyKind } from '../../../web/client/index';
import type { BodyDescription, FrameHeader, GridBlock, PoseBlock } from '../../../web/client/index';
import { kFinishes, lookOf } from '../../../web/viewer/view/base/appearance';
import { BodyView } from '../../../web/viewer/view/bodies/body_view';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';
import { solidOf } from '../../../web/viewer/view/solids/solid_of';
import { Workshop } from '../../../web/viewer/view/surface/workshop';
import { kSquareVertices } from '../../../web/viewer/view/particles/impostor';

const kBase = { body: 1, name: 'thing', material: 'wood', radius: 0.5 };

/** A box of 2 × 1 × 1 cells of one metre around the centre of mass. */
const kCrate: BodyDescription = {
  ...kBase,
  kind: 'rigid',
  particles: 2,
  local_positions: [-0.5, 0, 0, 0.5, 0, 0],
  shape: { type: 'box', size: [2, 1, 1] },
};

const kBar: BodyDescription = {
  ...kBase,
  kind: 'deformable',
  particles: 2,
  spacing: 1,
  rest_positions: [-0.5, 0, 0, 0.5, 0, 0],
  shape: { type: 'box', size: [2, 1, 1] },
};

const kQuantum = 0.01;

function viewOf(description: BodyDescription): BodyView {
  const view = new BodyView(
    description,
    0,
    lookOf({ opacity: 0.5 }),
    sharedUniforms(),
    new Workshop(),
    () => undefined,
  );
  view.addSolid(solidOf);
  view.solidStyle = 'shape';
  return view;
}

function headerAt(time: number): FrameHeader {
  const header = { origin: [0, 0, 0], quantum: kQuantum, attributeQuanta: [], time };
  return header as unknown as FrameHeader;
}

function blockAt(places: readonly number[]): GridBlock {
  const positions = Uint16Array.from(places, (x) => Math.round(x / kQuantum));
  return { kind: BodyKind.deformable, body: 1, positions, numbers: undefined, attributes: [] };
}

/** Returns the visible meshes except the shadow, the first. */
function shown(view: BodyView): Mesh[] {
  return view.group.children.slice(1).filter((child) => child.visible) as Mesh[];
}

/** Returns the extent of a mesh in world axes. */
function extentOf(view: BodyView, mesh: Mesh, attribute = 'position'): Box3 {
  const places = mesh.geometry.getAttribute(attribute);
  const box = new Box3();
  for (let i = 0; i < places.count; ++i) {
    box.expandByPoint(new Vector3().fromBufferAttribute(places, i).applyMatrix4(view.group.matrix));
  }
  return box;
}

const round = (point: Vector3): number[] => point.toArray().map((x) => Math.round(100 * x) / 100);

describe('The style of solids', () => {
  it('is the surface of the shape, with the pose of the body', () => {
    const view = viewOf(kCrate);
    const pose = { kind: BodyKind.rigid, body: 1, position: [5, 6, 7], orientation: [0, 0, 0, 1] };
    view.showPose(pose as unknown as PoseBlock, 0.02);
    view.phase = 1;
    const [solid, ...others] = shown(view);
    expect(others).toEqual([]);
    const { min, max } = extentOf(view, solid!);
    expect(round(min)).toEqual([4, 5.5, 6.5]);
    expect(round(max)).toEqual([6, 6.5, 7.5]);
  });

  it('can be particles, and is particles without a known shape', () => {
    const view = viewOf(kCrate);
    const [solid] = shown(view);
    view.solidStyle = 'particles';
    const [spheres, ...others] = shown(view);
    expect(others).toEqual([]);
    expect(spheres).not.toBe(solid);
    expect(spheres!.geometry.drawRange.count).toBe(2 * kSquareVertices);
    const unknown = structuredClone(kCrate);
    delete unknown.shape;
    const [shapeless] = shown(viewOf(unknown));
    expect(shapeless!.geometry.drawRange.count).toBe(2 * kSquareVertices);
  });

  it('is a ball for a rigid body of one particle', () => {
    const { body, name, material, radius } = kBase;
    const one = { body, name, material, radius, kind: 'rigid' as const, particles: 1 };
    const view = viewOf({ ...one, local_positions: [0, 0, 0] });
    const [solid] = shown(view);
    expect(round(extentOf(view, solid!).max)).toEqual([0.5, 0.5, 0.5]);
  });

  it('is a surface that follows the particles of a deformable body between frames', () => {
    const view = viewOf(kBar);
    view.showGrid(blockAt([3, 2, 2, 4, 2, 2]), headerAt(0));
    view.showGrid(blockAt([3, 2, 3, 4, 2, 3]), headerAt(0.02));
    const [solid, ...others] = shown(view);
    expect(others).toEqual([]);
    expect(round(extentOf(view, solid!).min)).toEqual([2.5, 1.5, 2.5]);
    expect(round(extentOf(view, solid!).max)).toEqual([4.5, 2.5, 3.5]);
    expect(round(extentOf(view, solid!, 'before').min)).toEqual([2.5, 1.5, 1.5]);
    view.rest();
    view.showGrid(blockAt([3, 2, 5, 4, 2, 5]), headerAt(0.04));
    expect(round(extentOf(view, solid!, 'before').min)).toEqual([2.5, 1.5, 4.5]);
  });

  it('stretches without a tearing strain, and tears beyond it until the time decreases', () => {
    const parted = [3, 2, 2, 6, 2, 2];
    const partsOf = (view: BodyView): number => {
      const [solid] = shown(view);
      const { array } = solid!.geometry.getAttribute('position');
      const xs = [...array].filter((_, i) => i % 3 === 0).map((x) => x * kQuantum);
      return xs.some((x) => x > 3.6 && x < 5.4) ? 1 : 2;
    };
    const view = viewOf(kBar);
    view.showGrid(blockAt(parted), headerAt(1));
    expect(partsOf(view)).toBe(1);
    view.tearingStrain = 0.5;
    view.showGrid(blockAt(parted), headerAt(2));
    expect(partsOf(view)).toBe(2);
    view.showGrid(blockAt([3, 2, 2, 4, 2, 2]), headerAt(3)); // together, but still torn
    const [solid] = shown(view);
    const torn = solid!.geometry.getAttribute('position').count;
    view.showGrid(blockAt([3, 2, 2, 4, 2, 2]), headerAt(0));
    expect(solid!.geometry.getAttribute('position').count).toBeLessThan(torn);
  });

  it('is hit by the pointer everywhere on a surface, but only on the spheres of particles', () => {
    const view = viewOf(kCrate);
    const pose = { kind: BodyKind.rigid, body: 1, position: [0, 0, 0], orientation: [1, 0, 0, 0] };
    view.showPose(pose as unknown as PoseBlock, 0.02);
    view.phase = 1;
    const edge = new Ray(new Vector3(0.98, 0.48, 5), new Vector3(0, 0, -1));
    const beside = new Ray(new Vector3(1.3, 0.6, 5), new Vector3(0, 0, -1));
    expect(view.pick(edge)?.particle).toBe(1);
    expect(view.pick(beside)).toBeUndefined();
    view.solidStyle = 'particles';
    expect(view.pick(edge)).toBeUndefined();
  });

  it('has the opacity and the finish of the material', () => {
    const view = viewOf(kCrate);
    const [solid] = shown(view);
    expect(solid!.material).toMatchObject({ transparent: true, defines: { FINISH: 0 } });
    view.look = lookOf({ finish: 'brick' });
    const brick = kFinishes.indexOf('brick');
    expect(solid!.material).toMatchObject({ transparent: false, defines: { FINISH: brick } });
  });

  it('has spots as shadows only below particles', () => {
    const view = viewOf(kCrate);
    const [spots] = view.group.children;
    expect(spots!.visible).toBe(false);
    view.solidStyle = 'particles';
    expect(spots!.visible).toBe(true);
  });
});
