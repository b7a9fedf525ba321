import { Matrix4, Vector3 } from 'three';
import type { DataTexture } from 'three';
import { describe, expect, it } from 'vitest';
import { BodyKind } from '../../../web/client/index';
import type { GridBlock, PoseBlock } from '../../../web/client/index';
import { ParticleColumns } from '../../../web/viewer/view/particles/particle_columns';
import { RigidMotion } from '../../../web/viewer/view/particles/rigid_motion';

const kGrid = { origin: [0, 0, 0] as [number, number, number], quantum: 1 };

/** Particles at these x with these numbers. */
function block(x: number[], numbers?: number[]): GridBlock {
  const positions = new Uint16Array(3 * x.length);
  x.forEach((value, i) => (positions[3 * i] = value));
  return {
    kind: BodyKind.liquid,
    body: 1,
    positions,
    numbers: numbers && Uint32Array.from(numbers),
    attributes: [],
  };
}

/** Returns the displayed x at a phase. */
function shown(columns: ParticleColumns, phase: number): number[] {
  const all = columns.coordinates(phase);
  return Array.from({ length: columns.count }, (_, i) => all[3 * i]!);
}

describe('ParticleColumns', () => {
  it('interpolates particles between two frames', () => {
    const columns = new ParticleColumns(2);
    columns.show(block([10, 20]), kGrid);
    expect(shown(columns, 0)).toEqual([10, 20]);
    columns.show(block([14, 28]), kGrid);
    expect(shown(columns, 0)).toEqual([10, 20]);
    expect(shown(columns, 0.25)).toEqual([11, 22]);
    expect(shown(columns, 1)).toEqual([14, 28]);
    expect(columns.coordinate(3, 0.25)).toBe(22);
    columns.show(block([14, 30]), kGrid);
    expect(shown(columns, 0.5)).toEqual([14, 29]);
  });

  it('sends only the new positions to the graphics', () => {
    const columns = new ParticleColumns(2);
    const { center_texels: center, before_texels: before, name_texels: names } = columns.uniforms;
    const versions = (): number[] => [center, before, names].map(({ value }) => value.version);
    columns.show(block([1, 2]), kGrid);
    columns.show(block([3, 4]), kGrid);
    const [newest, old, known] = versions();
    columns.show(block([5, 6]), kGrid);
    expect(versions()).toEqual([old! + 1, newest, known]);
    const data = ({ value }: { value: DataTexture }, count: number): number[] => [
      ...(value.image.data as Uint16Array).subarray(0, count),
    ];
    expect(data(center, 6)).toEqual([5, 0, 0, 6, 0, 0]);
    expect(data(before, 6)).toEqual([3, 0, 0, 4, 0, 0]);
    columns.showValues(Int32Array.of(7, 8));
    expect(data(columns.uniforms.value_texels, 2)).toEqual([7, 8]);
  });

  it('knows particles again by their numbers, and has those that come stand still', () => {
    const columns = new ParticleColumns(2);
    columns.show(block([10, 20], [3, 7]), kGrid);
    columns.show(block([24, 100, 110], [7, 8, 9]), kGrid);
    expect(shown(columns, 0)).toEqual([20, 100, 110]);
    expect(shown(columns, 0.5)).toEqual([22, 100, 110]);
    columns.show(block([26, 120], [7, 9]), kGrid);
    expect(shown(columns, 0)).toEqual([24, 110]);
  });

  it('carries positions over to another grid', () => {
    const columns = new ParticleColumns(1);
    columns.show(block([100]), kGrid);
    columns.show(block([60]), { origin: [-10, 0, 0], quantum: 2 });
    expect(shown(columns, 0)).toEqual([55]); // (100 + 10) / 2
    expect(shown(columns, 1)).toEqual([60]);
  });
});

function pose(x: number, angle: number): PoseBlock {
  return {
    kind: BodyKind.rigid,
    body: 1,
    position: [x, 0, 0],
    orientation: [Math.cos(angle / 2), 0, 0, Math.sin(angle / 2)],
  };
}

describe('RigidMotion', () => {
  it('moves and turns evenly from pose to pose', () => {
    const motion = new RigidMotion();
    motion.add(pose(1, 0));
    motion.add(pose(3, Math.PI / 2));
    const matrix = new Matrix4();
    motion.matrixAt(0.5, matrix);
    const tip = new Vector3(1, 0, 0).applyMatrix4(matrix);
    expect(tip.x).toBeCloseTo(2 + Math.SQRT1_2);
    expect(tip.y).toBeCloseTo(Math.SQRT1_2);
  });

  it.each([
    [0.3, 0.3],
    [-0.3, -0.3],
  ])('rotates by %f in 0.1 s, and has its velocities', (angle, turned) => {
    const motion = new RigidMotion();
    motion.add(pose(1, 1));
    motion.add(pose(1.5, 1 + angle));
    const [linear, angular] = [new Vector3(), new Vector3()];
    motion.velocities(0.1, linear, angular);
    expect(linear.x).toBeCloseTo(5);
    expect(angular.z).toBeCloseTo(turned / 0.1);
    motion.velocities(0, linear, angular);
    expect(linear.length() + angular.length()).toBe(0);
  });

  it('is at rest until it has two poses', () => {
    const motion = new RigidMotion();
    motion.add(pose(4, 1));
    const matrix = new Matrix4();
    motion.matrixAt(0, matrix);
    expect(new Vector3().applyMatrix4(matrix).x).toBe(4);
  });
});
