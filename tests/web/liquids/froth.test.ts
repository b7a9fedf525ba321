import { expect, it } from 'vitest';
import { BodyKind } from '../../../web/client/index';
import { Froth } from '../../../web/viewer/view/fluid/froth';
import { kSquareVertices } from '../../../web/viewer/view/particles/impostor';
import { JoinedColumns } from '../../../web/viewer/view/particles/joined_columns';
import { ParticleColumns } from '../../../web/viewer/view/particles/particle_columns';

const kGrid = { origin: [0, 0, 0] as [number, number, number], quantum: 0.001 };
const kLiquid: typeof BodyKind.liquid = BodyKind.liquid;
const kRadius = 0.01;
const kHeight = 1; // a fall from here ends with 4.4 m/s
const kSeconds = 0.02;
/** Side of the lattice, and the index of its centre. Its particles are two radii apart. */
const kSide = 9;
const kCentre = 4 * kSide * kSide + 4 * kSide + 4;

/** The lattice and one particle far from it, all moved by `way` [m]. */
function places(way: (particle: number) => number): Uint16Array<ArrayBuffer> {
  const all: number[] = [];
  for (let i = 0; i < kSide ** 3; ++i) {
    const at = [i % kSide, Math.floor(i / kSide) % kSide, Math.floor(i / kSide ** 2)];
    all.push(...at.map((n) => 1000 + 20 * n));
  }
  all.push(5000, 1000, 1000);
  return Uint16Array.from(all, (x, i) => x + (i % 3 === 0 ? way(Math.floor(i / 3)) / 0.001 : 0));
}

interface ParticleFroth {
  foam: number;
  lone: number;
}

function frothOf({ columns, geometry }: JoinedColumns): ParticleFroth[] {
  const { values } = columns.froth;
  return Array.from({ length: geometry.drawRange.count / kSquareVertices }, (_, i) => ({
    foam: values[2 * i]! / 255,
    lone: values[2 * i + 1]! / 255,
  }));
}

class Scene {
  readonly columns = new ParticleColumns(kSide ** 3 + 1);
  readonly joined = new JoinedColumns();
  readonly froth = new Froth();

  show(way: (particle: number) => number): void {
    const block = { kind: kLiquid, body: 1, numbers: undefined, attributes: [] };
    this.columns.show({ ...block, positions: places(way) }, kGrid);
  }

  follow(seconds = kSeconds): ParticleFroth[] {
    const liquid = { body: 1, row: 0, columns: this.columns, valueQuantum: 1, radius: kRadius };
    this.joined.update([liquid]);
    this.froth.follow([liquid], this.joined, {
      ...kGrid,
      seconds,
      height: kHeight,
    });
    return frothOf(this.joined);
  }
}

/** Returns the froth after all particles moved with their speeds [m/s]. */
function after(speed: (particle: number) => number): ParticleFroth[] {
  const scene = new Scene();
  scene.show((i) => -speed(i) * kSeconds);
  scene.show(() => 0);
  return scene.follow();
}

it.each([
  ['a liquid at rest', () => 0, 0, 0],
  ['a fast liquid that moves as a whole', () => 4, 0, 1],
  ['a slow one', () => 0.5, 0, 0],
])('makes foam of isolated fast particles only: %s', (_, speed, within, alone) => {
  const froth = after(speed);
  expect(froth[kCentre]).toEqual({ foam: within, lone: 0 });
  expect(froth.at(-1)).toEqual({ foam: alone, lone: 1 });
});

it('makes foam of turbulence at the surface, not below it', () => {
  const froth = after((i) => (i % 2 === 0 ? 3 : -3));
  expect(froth[0]!.foam).toBe(1); // a corner
  expect(froth[kCentre]!.foam).toBe(0);
});

it('fades with simulated time, and is the same while the scene is paused', () => {
  const scene = new Scene();
  scene.show(() => 0);
  scene.show(() => 4 * kSeconds);
  const foam = (seconds: number): number => scene.follow(seconds).at(-1)!.foam;
  expect(foam(kSeconds)).toBe(1);
  scene.show(() => 4 * kSeconds); // no motion
  expect(foam(0)).toBe(1);
  expect(foam(0)).toBe(1);
  // 1.5 times the time of a fall from the height.
  expect(foam(1.5 * Math.sqrt((2 * kHeight) / 9.81))).toBeCloseTo(Math.exp(-1), 2);
});

it('is removed if the time decreases, and with the scene', () => {
  for (const forget of [
    (scene: Scene) => scene.froth.clear(),
    (scene: Scene) => scene.follow(-1),
  ]) {
    const scene = new Scene();
    scene.show(() => 0);
    scene.show(() => 4 * kSeconds);
    expect(scene.follow().at(-1)!.foam).toBe(1);
    scene.show(() => 4 * kSeconds);
    forget(scene);
    expect(scene.follow(0).at(-1)!.foam).toBe(0);
  }
});

it('follows particles by their numbers', () => {
  const columns = new ParticleColumns(1);
  const froth = new Froth();
  const foamOf = (numbers: number[], x: number[], seconds: number): number[] => {
    const positions = Uint16Array.from(x.flatMap((at) => [at, 0, 0]));
    const block = {
      kind: kLiquid,
      body: 1,
      numbers: Uint32Array.from(numbers),
      attributes: [],
      positions,
    };
    columns.show(block, kGrid);
    const joined = new JoinedColumns();
    const liquid = { body: 1, row: 0, columns, valueQuantum: 1, radius: kRadius };
    joined.update([liquid]);
    froth.follow([liquid], joined, { ...kGrid, seconds, height: kHeight });
    return frothOf(joined).map(({ foam }) => foam);
  };
  foamOf([3, 7], [0, 5000], 0);
  expect(foamOf([3, 7], [0, 5080], kSeconds)).toEqual([0, 1]);
  // The first has been drained, and another has been emitted.
  expect(foamOf([7, 8], [5080, 9000], 0)).toEqual([1, 0]);
});
