import { describe, expect, it } from 'vitest';
import { AnimationFrames } from '../../../web/viewer/view/pace/animation_frames';
import { UnfinishedPictures } from '../../../web/viewer/view/pace/unfinished_pictures';

/** A frame draws its picture, waits for shaders, or has none. */
type Kind = 'picture' | 'waits' | 'none';

describe('animation frames', () => {
  const follows = { follows: true, isIdle: false, isStill: false };
  const busy = { follows: false, isIdle: false, isStill: false };
  const idle = { follows: false, isIdle: true, isStill: false };
  const still = { follows: false, isIdle: true, isStill: true };
  it.each<[string, [number, Kind][], object]>([
    [
      'a picture after a picture',
      [
        [0, 'picture'],
        [17, 'picture'],
      ],
      follows,
    ],
    [
      'a picture after one that waits for shaders',
      [
        [0, 'waits'],
        [17, 'picture'],
      ],
      busy,
    ],
    [
      'the end of a slow picture',
      [
        [0, 'picture'],
        [700, 'none'],
      ],
      busy,
    ],
    [
      'no picture',
      [
        [0, 'picture'],
        [700, 'none'],
        [717, 'none'],
      ],
      idle,
    ],
    [
      'no picture for some time',
      [
        [0, 'picture'],
        [17, 'none'],
        [400, 'none'],
      ],
      still,
    ],
    [
      'no picture soon after a wait',
      [
        [0, 'waits'],
        [400, 'waits'],
        [417, 'none'],
      ],
      idle,
    ],
    [
      'a single picture',
      [
        [0, 'picture'],
        [17, 'none'],
        [400, 'picture'],
      ],
      { ...busy, isStill: true },
    ],
  ])('know %s', (_, rows, expected) => {
    const frames = new AnimationFrames();
    let course: object = {};
    for (const [at, kind] of rows) {
      course = frames.begin(at, kind !== 'none');
      if (kind === 'picture') frames.drew();
    }
    expect(course).toEqual(expected);
  });
});

describe('unfinished pictures', () => {
  it('are two at most, and none after the loss of the context', () => {
    const unsignaled = 3;
    const status = new Map<object, unknown>();
    let isLost = false;
    const gl = {
      SYNC_GPU_COMMANDS_COMPLETE: 1,
      SYNC_STATUS: 2,
      UNSIGNALED: unsignaled,
      isContextLost: () => isLost,
      getSyncParameter: (fence: object) => status.get(fence),
      deleteSync: (fence: object) => status.delete(fence),
      fenceSync: () => {
        const fence = {};
        status.set(fence, unsignaled);
        return fence;
      },
      flush: () => undefined,
    };
    const signal = (value: unknown) => {
      const [first] = [...status].filter(([, state]) => state === unsignaled);
      status.set(first![0], value);
    };
    const pictures = new UnfinishedPictures(gl as unknown as WebGL2RenderingContext);
    const drawOne = () => {
      expect(pictures.areMost()).toBe(false);
      pictures.add();
    };
    drawOne();
    drawOne();
    expect(pictures.areMost()).toBe(true);
    signal(4);
    drawOne();
    expect(pictures.areMost()).toBe(true);
    signal(null); // the fence is that of another context
    drawOne();
    expect(pictures.areMost()).toBe(true);
    isLost = true;
    expect(pictures.areMost()).toBe(false);
  });
});
