import { describe, expect, it } from 'vitest';
import { FrameDecoder, FrameRecording, RecordingError } from '../../../web/client/index';
import { goldenBytes } from '../golden';
import { goldenRecording, sourceIn, withDescription } from './golden_recording';

const open = (bytes: Uint8Array<ArrayBuffer>): Promise<FrameRecording> =>
  FrameRecording.open(sourceIn(bytes));

/** Returns the code and the message of a file's first error. */
async function faultOf(bytes: Uint8Array<ArrayBuffer>): Promise<RecordingError> {
  try {
    await open(bytes);
  } catch (error) {
    if (error instanceof RecordingError) return error;
    throw error;
  }
  throw new Error('the file is valid');
}

const kDescription = {
  epoch: 1,
  scene: 'twice',
  title: '',
  tick_seconds: 0.02,
  gravity: [0, 0, -9.81],
  vat: null,
  materials: [{ name: 'wood', appearance: { colour: '#806040', roughness: 0.6, finish: 'wood' } }],
  bodies: [
    {
      body: 1,
      name: 'pair',
      kind: 'rigid',
      material: 'wood',
      particles: 1,
      radius: 0.1,
      local_positions: [0, 0, 0],
      shape: { type: 'sphere', radius: 0.1, center: [0, 0, 0] },
    },
  ],
};

describe('a recording of frames', () => {
  it('has a description and frames', async () => {
    const recording = await open(goldenRecording());
    expect(recording.frameCount).toBe(4);
    expect(recording.frameSeconds).toBe(0.02);
    const { description } = recording.sceneAt(3);
    expect(description).toMatchObject({ scene: 'twice', name: 'Two particles', tick: 0 });
    expect(description.bodies[0]).toMatchObject({ name: 'pair', kind: 'liquid', particles: 2 });
    expect(description.vat).toEqual({ min: [-1, -1, -1], max: [1, 1, 1], lid: false });
  });

  it('gives the frames of a group', async () => {
    const recording = await open(goldenRecording());
    expect([0, 1, 2, 3].map((frame) => recording.keyBefore(frame))).toEqual([0, 0, 2, 2]);
    for (const frame of [3, 0, 2, 1]) {
      const { first, frames } = await recording.group(frame);
      expect(first).toBe(frame - (frame % 2));
      expect(frames).toEqual([goldenBytes('v2-twice'), goldenBytes('v2-twice-one')]);
      const decoder = new FrameDecoder();
      for (const bytes of frames) decoder.decode(bytes);
    }
  });

  it('is refused if it is cut', async () => {
    const bytes = goldenRecording();
    for (let length = 0; length < bytes.length; ++length) {
      const { code } = await faultOf(bytes.slice(0, length));
      expect(code, `${length} bytes`).toBe(length < 8 ? 'other_format' : 'incomplete');
    }
  });

  it('is refused if a byte of header, description, index or end differs', async () => {
    const bytes = goldenRecording();
    const indexAt = bytes.length - 16 - (8 + 12 + 4 * 4);
    const framesAt = 12 + new DataView(bytes.buffer).getUint32(indexAt + 12, true);
    for (let at = 0; at < bytes.length; ++at) {
      if (at >= framesAt && at < indexAt) continue; // frames have their own check
      bytes[at]! ^= 16;
      const { code } = await faultOf(bytes);
      bytes[at]! ^= 16;
      const expected = at < 8 ? /other_format/ : at < 12 ? /other_version/ : /damaged|incomplete/;
      expect(code, `byte ${at}`).toMatch(expected);
    }
  });

  it('is explained if it contains commands', async () => {
    const bytes = goldenRecording();
    bytes.set(new TextEncoder().encode('vat.rec\n'));
    expect(await faultOf(bytes)).toMatchObject({ code: 'commands' });
  });

  const body = kDescription.bodies[0]!;
  const wood = kDescription.materials[0]!;
  const withShape = (shape: object): object => ({ bodies: [{ ...body, shape }] });

  it.each([
    ['a sphere', {}],
    ['a box', withShape({ type: 'box', size: [1, 2, 3] })],
    ['a cylinder', withShape({ type: 'cylinder', radius: 1, height: 2, axis: [0, 1, 0] })],
    [
      'a mesh',
      withShape({
        type: 'mesh',
        vertices: [
          [0, 0, 0],
          [1, 0, 0],
          [0, 1, 0],
        ],
        triangles: [[0, 1, 2]],
      }),
    ],
    [
      'a deformable body',
      { bodies: [{ ...body, kind: 'deformable', spacing: 0.1, rest_positions: [0, 0, 0] }] },
    ],
    ['a tearing material', { materials: [{ ...wood, tearing_strain: 0.2 }] }],
  ])('has the members of its description: %s', async (_, change) => {
    const changed = { ...kDescription, ...change };
    const recording = await open(withDescription(JSON.stringify(changed)));
    const { description } = recording.sceneAt(0);
    expect(description.name).toBe('twice');
    expect(description.materials).toEqual(changed.materials);
    const [given] = changed.bodies;
    const { local_positions: local, ...rest } = description.bodies[0]!;
    expect(rest).toEqual({ ...given, local_positions: undefined });
    if (rest.kind === 'rigid') expect(local).toEqual([0, 0, 0]);
  });

  it.each([
    ['JSON', 'no JSON', 'the description must be JSON'],
    ['an object', '[]', 'an object'],
    ['scene', { scene: 7 }, 'scene must be a text'],
    ['title', { title: 'a'.repeat(5000) }, 'title must be a text of at most 4096'],
    ['tick', { tick_seconds: 0 }, 'tick_seconds must be a number from'],
    ['gravity', { gravity: [0, 0] }, 'gravity must be three numbers'],
    ['gravity values', { gravity: [0, 0, '1'] }, 'gravity must be a number'],
    ['vat', { vat: 1 }, 'vat must be an object'],
    ['lid', { vat: { min: [0, 0, 0], max: [1, 1, 1] } }, 'lid must be true or false'],
    ['bodies', { bodies: {} }, 'bodies must be a list'],
    [
      'kind',
      { bodies: [{ ...body, kind: 'gas' }] },
      'kind must be one of liquid, deformable, rigid',
    ],
    ['radius', { bodies: [{ ...body, radius: -1 }] }, 'radius must be a number from 0'],
    ['positions', { bodies: [{ ...body, particles: 2 }] }, 'local_positions must be three numbers'],
    ['body', { bodies: [{ ...body, body: 1.5 }] }, 'body must be a whole number'],
    ['materials', { materials: 1 }, 'materials must be a list'],
    ['colour', { materials: [{ ...wood, appearance: { colour: 'red' } }] }, 'colour must be #'],
    ['roughness', { materials: [{ ...wood, appearance: { roughness: 2 } }] }, 'roughness must'],
    ['finish', { materials: [{ ...wood, appearance: { finish: 'x' } }] }, 'finish must be one of'],
    ['shape', withShape({ type: 'particles' }), 'type must be one of box, sphere, cylinder, mesh'],
    ['size', withShape({ type: 'box', size: [1, 0, 1] }), 'size must be a number from'],
    [
      'axis',
      withShape({ type: 'cylinder', radius: 1, height: 1, axis: [1] }),
      'axis must be three',
    ],
    [
      'triangles',
      withShape({ type: 'mesh', vertices: [[0, 0, 0]], triangles: [[0, 0, 1]] }),
      'triangles must be numbers of vertices',
    ],
    ['spacing', { bodies: [{ ...body, spacing: 0 }] }, 'spacing must be a number'],
    ['rest', { bodies: [{ ...body, rest_positions: [0] }] }, 'rest_positions must be three'],
    ['more', { bodies: [{ ...body, local_positions: [0, 0, 0, 0] }] }, 'local_positions must be'],
  ])('with a wrong description is refused: %s', async (_, change, words) => {
    const text =
      typeof change === 'string' ? change : JSON.stringify({ ...kDescription, ...change });
    const { code, message } = await faultOf(withDescription(text));
    expect(code).toBe('bad_value');
    expect(message).toContain(words);
  });
});
