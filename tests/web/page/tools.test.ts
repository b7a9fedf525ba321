import { Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import type { Scene } from '../../../web/client/index';
import { SceneDocument } from '../../../web/viewer/build/scene_document';
import type { Desk } from '../../../web/viewer/panel/desk';
import { Push, Pusher, speedOf } from '../../../web/viewer/tools/push';
import { leanInView } from '../../../web/viewer/tools/tilt';

const kStart = { body: 3, particle: 0, target: [1, 1, 1] as [number, number, number] };

describe('the speed of a push', () => {
  it.each([
    [0.5, 2 * Math.sqrt(2 * 9.81 * 2) * 0.25],
    [2, 2 * Math.sqrt(2 * 9.81 * 2)],
    [20, 2 * Math.sqrt(2 * 9.81 * 2)], // the maximum
  ])('of a drag of %d m in a scene of 2 m is %d m/s', (length, speed) => {
    const found = speedOf(new Vector3(0, length, 0), 2);
    expect(found.x).toBe(0);
    expect(found.y).toBeCloseTo(speed, 12);
  });
});

describe('Push', () => {
  it.each([
    [true, [[3, [0, 0, 1]]]],
    [false, []],
  ])('reports the drag if it is completed: %s', (isDone, expected) => {
    const told: unknown[] = [];
    const push = new Push(kStart, (body, drag) => told.push([body, drag.toArray()]));
    push.move([5, 5, 5]);
    push.move([1, 1, 2]);
    push.end(isDone);
    expect(told).toEqual(expected);
  });
});

const kScene: Scene = {
  format: 'vat.scene/1',
  materials: [{ name: 'wood', density: 500 }],
  bodies: [
    {
      name: 'crate',
      kind: 'rigid',
      material: 'wood',
      spacing: 0.1,
      shape: { type: 'box', size: [0.3, 0.2, 0.1] },
    },
  ],
};

describe('Pusher', () => {
  const body = { name: 'crate', material: 'wood', particles: 8, radius: 0.05 };

  /** Returns the requests of a push by this drag in a scene of 1 m. */
  async function pushed(drag: Vector3, shown = body, scene?: Scene): Promise<unknown[]> {
    const sent: unknown[] = [];
    const request = ((method: string, params: unknown) => {
      if (method === 'scene.get') return scene ? Promise.resolve({ scene }) : Promise.reject();
      sent.push([method, params]);
      return Promise.resolve({});
    }) as Desk['request'];
    const desk = { request } as Desk;
    const pusher = new Pusher(
      desk,
      new SceneDocument(request),
      () => shown,
      () => 1,
    );
    await pusher.push(3, drag);
    return sent;
  }

  const speed = 2 * Math.sqrt(2 * 9.81) * 0.5; // of half the scene's height

  it.each([
    ['of the scene', body, kScene, 500 * 0.3 * 0.2 * 0.1],
    ['estimated from particles', { ...body, name: 'drop' }, kScene, 500 * 8 * 0.1 ** 3],
    ['estimated without a scene', body, undefined, 1000 * 8 * 0.1 ** 3],
  ])('gives the body its speed by the mass %s', async (_, shown, scene, mass) => {
    const [[method, params]] = (await pushed(new Vector3(0.5, 0, 0), shown, scene)) as [
      [string, { body: number; force: number[]; duration: number }],
    ];
    expect(method).toBe('world.apply_force');
    expect(params.body).toBe(3);
    expect((params.force[0]! * params.duration) / mass).toBeCloseTo(speed, 9);
    expect(params.force.slice(1)).toEqual([0, 0]);
  });

  it('does not push for a click', async () => {
    expect(await pushed(new Vector3(0.005, 0, 0), body, kScene)).toEqual([]);
  });
});

describe('a tilt in the view', () => {
  it.each([
    [
      [0, 1, -0.5],
      [1, 0],
      [0, 1],
    ],
    [
      [-1, 0, -0.1],
      [0, 1],
      [-1, 0],
    ],
  ])('of a camera along %s tilts to the right along %s and away along %s', (look, right, away) => {
    const parts = leanInView(10, 20, new Vector3(...look));
    expect(parts.map(({ degrees }) => degrees)).toEqual([10, 20]);
    const [a, b] = parts.map(({ along }) => along.map((x) => x + 0));
    expect([a, b]).toEqual([right, away]);
  });
});
