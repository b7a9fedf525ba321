import { Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { CameraMotion } from '../../../web/viewer/camera/camera_motion';
import type { MovedCamera } from '../../../web/viewer/camera/camera_motion';
import { Chase } from '../../../web/viewer/camera/chase';
import { Flight, kFlightSeconds } from '../../../web/viewer/camera/flight';
import { IdleOrbit, kIdleSeconds } from '../../../web/viewer/camera/idle_orbit';
import { directionOf, kPresets } from '../../../web/viewer/view/base/presets';
import type { Pose } from '../../../web/viewer/view/base/pose';

const poseAt = (eye: number[], target = [0, 0, 0]): Pose => ({
  eye: new Vector3().fromArray(eye),
  target: new Vector3().fromArray(target),
});

const lengthOf = ({ eye, target }: Pose): number => eye.distanceTo(target);

describe('Flight', () => {
  const from = poseAt([-2, 0.1, 0]);
  const to = poseAt([-4, -0.2, 0.1], [0, 1, 0]);
  const flight = new Flight(from, to, 10);

  it('moves from one pose to the other', () => {
    expect(flight.poseAt(10).eye.distanceTo(from.eye)).toBeLessThan(1e-9);
    expect(flight.isOver(10 + 0.9 * kFlightSeconds)).toBe(false);
    expect(flight.isOver(10.001 + kFlightSeconds)).toBe(true);
    expect(flight.poseAt(11)).toEqual(to);
  });

  it('takes the shorter way around the target', () => {
    const { eye, target } = flight.poseAt(10 + kFlightSeconds / 2);
    expect(eye.x - target.x).toBeLessThan(-1.9); // the other way has positive x
    const length = Math.sqrt(lengthOf(from) * lengthOf(to));
    expect(lengthOf({ eye, target })).toBeCloseTo(length, 9);
  });

  it('ends immediately for users who prefer reduced motion', () => {
    expect(new Flight(from, to, -Infinity).poseAt(0)).toEqual(to);
  });
});

describe('the presets', () => {
  it.each(kPresets)('%s is above the horizon', (preset) => {
    const way = directionOf(preset);
    expect(way.length()).toBeCloseTo(1, 12);
    expect(way.z).toBeGreaterThan(0);
  });
});

describe('Chase', () => {
  it('approaches a body, keeps direction and distance, and rests on it', () => {
    const chase = new Chase(true);
    const place = new Vector3(1.1, 2.3, 0.7);
    let pose = poseAt([0, -5.3, 1.7], [0.123456, 0.1, 1 / 3]);
    const before = pose.eye.clone().sub(pose.target);
    let moves = 0;
    for (let n = 0; n < 500; ++n) {
      const next = chase.follow(pose, place, n / 60);
      if (!next) continue;
      pose = next;
      moves = n;
    }
    expect(pose.target.distanceTo(place)).toBeLessThan(1e-8);
    expect(pose.eye.clone().sub(pose.target).distanceTo(before)).toBeLessThan(1e-9);
    expect(moves).toBeGreaterThan(10);
    expect(moves).toBeLessThan(200);
  });

  it('is on the body at once without a lag', () => {
    const pose = new Chase(false).follow(poseAt([0, -5, 1]), new Vector3(1, 2, 0), 0);
    expect(pose).toEqual(poseAt([1, -3, 1], [1, 2, 0]));
  });
});

/** An orbit with a clock and inputs that a test controls. */
function orbitAt(start: number) {
  const source = new EventTarget();
  const clock = { now: start };
  return { clock, source, orbit: new IdleOrbit(source, () => clock.now) };
}

describe('IdleOrbit', () => {
  /** Returns the sum of the turns of pictures until a time, 20 per second. */
  const turned = ({ clock, orbit }: ReturnType<typeof orbitAt>, until: number): number => {
    let sum = 0;
    for (; clock.now < until; clock.now += 0.05) sum += orbit.turn();
    return sum;
  };

  it('begins after some time, and turns once in two minutes', () => {
    const idle = orbitAt(100);
    expect(turned(idle, 100 + kIdleSeconds)).toBe(0);
    turned(idle, 160);
    expect(turned(idle, 190)).toBeCloseTo(Math.PI / 2, 1);
  });

  it.each(['pointerdown', 'pointermove', 'wheel', 'keydown', 'touchstart'])(
    'stops at the input %s',
    (type) => {
      const idle = orbitAt(0);
      expect(turned(idle, 60)).toBeGreaterThan(0);
      idle.source.dispatchEvent(new Event(type));
      expect(turned(idle, 60 + kIdleSeconds - 1)).toBe(0);
    },
  );

  it('does not make up for a pause', () => {
    const idle = orbitAt(0);
    turned(idle, 60);
    idle.clock.now = 900;
    expect(idle.orbit.turn()).toBe(0);
  });
});

describe('CameraMotion', () => {
  /** A camera that counts its movements. */
  class Camera implements MovedCamera {
    moves = 0;
    isStale = false;
    private current = poseAt([0, -5, 1]);
    get pose(): Pose {
      return this.current;
    }
    set pose(pose: Pose) {
      this.current = pose;
      ++this.moves;
    }
    poseFrom(direction: Vector3): Pose {
      return { eye: direction.clone().multiplyScalar(3), target: new Vector3() };
    }
  }

  function motionOf({ isCalm = false, place = undefined as Vector3 | undefined } = {}) {
    const { clock, orbit } = orbitAt(0);
    const camera = new Camera();
    const motion = new CameraMotion(
      camera,
      () => place,
      orbit,
      () => isCalm,
    );
    const run = (seconds: number): void => {
      const end = clock.now + seconds;
      for (; clock.now < end; clock.now += 0.05) motion.update(clock.now);
    };
    return { camera, motion, clock, run };
  }

  it('does not orbit while no picture is drawn', () => {
    const { camera, run } = motionOf();
    run(3 * kIdleSeconds);
    expect(camera.moves).toBe(0);
    camera.isStale = true;
    run(1);
    expect(camera.moves).toBeGreaterThan(0);
  });

  it.each([
    [{ isCalm: true }, true],
    [{}, false],
  ])('does not orbit with %o and orbits: %s', (options, orbits) => {
    const { camera, motion, run } = motionOf(options);
    motion.orbits = orbits;
    camera.isStale = true;
    run(3 * kIdleSeconds);
    expect(camera.moves).toBe(0);
  });

  it('flies to a preset, unless the user moves the camera', () => {
    const { camera, motion, clock, run } = motionOf();
    motion.show('top', clock.now);
    run(0.1);
    motion.interrupt();
    const { moves } = camera;
    run(2);
    expect(camera.moves).toBe(moves);
    motion.show('top', clock.now);
    run(2);
    expect(camera.pose.eye.z).toBeCloseTo(3, 2);
  });

  it('follows a body until a preset is chosen, and rests with it', () => {
    const place = new Vector3(1, 0, 0);
    const { camera, motion, clock, run } = motionOf({ place });
    motion.follow(1);
    run(4);
    expect(camera.pose.target).toEqual(place);
    const { moves } = camera;
    run(2);
    expect(camera.moves).toBe(moves);
    motion.show('front', clock.now);
    run(2);
    expect(camera.pose.target.x).toBe(0);
    expect(motion.body).toBeUndefined();
  });
});
