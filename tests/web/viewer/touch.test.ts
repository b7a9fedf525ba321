import { Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { RequestError } from '../../../web/client/index';
import { describeError } from '../../../web/viewer/panel/errors';
import { gravityOf, tiltOf } from '../../../web/viewer/panel/gravity/gravity';
import { readScene } from '../../../web/viewer/panel/scene_file';
import { onlyPaceDiffers, summarise } from '../../../web/viewer/panel/status/summary';
import { shareLink } from '../../../web/viewer/people/share';
import { linkedMoment } from '../../../web/viewer/stream/address';
import { linkedRecording } from '../../../web/viewer/stream/recording_file';
import { poseFromText, poseToText, turned } from '../../../web/viewer/view/base/pose';

const kPose = { eye: new Vector3(1, -2, 1), target: new Vector3(0, 0, 0.5) };

describe('a pose of the camera', () => {
  it('keeps its distance and its target while it rotates', () => {
    const after = turned(kPose, 0.3, 0.1, 1);
    expect(after.target).toEqual(kPose.target);
    expect(after.eye.distanceTo(after.target)).toBeCloseTo(kPose.eye.distanceTo(kPose.target), 12);
    const back = turned(after, -0.3, -0.1, 1);
    expect(back.eye.distanceTo(kPose.eye)).toBeLessThan(1e-12);
  });

  it('moves up and to the right by the given distances', () => {
    expect(turned(kPose, 0, 0.1, 1).eye.z).toBeGreaterThan(kPose.eye.z);
    expect(turned(kPose, 0.1, 0, 1).eye.x).toBeGreaterThan(kPose.eye.x);
  });

  it('never looks from below', () => {
    expect(turned(kPose, 0, -9, 1).eye.z).toBeGreaterThan(kPose.target.z);
  });

  it('is half as far with a zoom of two', () => {
    const { eye, target } = turned(kPose, 0, 0, 2);
    expect(eye.distanceTo(target)).toBeCloseTo(kPose.eye.distanceTo(kPose.target) / 2, 12);
  });

  it('has a text form that can be read', () => {
    expect(poseToText(kPose)).toBe('1,-2,1,0,0,0.5');
    expect(poseFromText(poseToText(kPose))).toEqual(kPose);
  });

  it.each(['', '1,2,3', '1,2,3,4,5,x', '1,2,3,1,2,3', '1,2,3,4,5,Infinity'])(
    'is not read from "%s"',
    (text) => expect(poseFromText(text)).toBeUndefined(),
  );
});

describe('gravity', () => {
  it('points down without a tilt', () => {
    expect(gravityOf({ strength: 9.81, x: 0, y: 0 })).toEqual([0, 0, -9.81]);
  });

  it.each([
    { strength: 9.81, x: 30, y: 0 },
    { strength: 3, x: -20, y: 45 },
    { strength: 0, x: 0, y: 0 },
  ])('has the components of %o, and the reverse', (tilt) => {
    const gravity = gravityOf(tilt);
    expect(Math.hypot(...gravity)).toBeCloseTo(tilt.strength, 12);
    const back = tiltOf(gravity);
    expect(back.x).toBeCloseTo(tilt.x, 9);
    expect(back.y).toBeCloseTo(tilt.y, 9);
  });

  it('pulls along x by the sine of a tilt along x', () => {
    const [x, , z] = gravityOf({ strength: 10, x: 30, y: 0 });
    expect(x).toBeCloseTo(5, 12);
    expect(z).toBeCloseTo(-10 * Math.cos(Math.PI / 6), 12);
  });
});

describe('a scene file', () => {
  it('is named as the file unless it has a name', () => {
    const text = '{"format": "vat.scene/1", "materials": [], "bodies": []}';
    expect(readScene(text, 'pool.json')).toMatchObject({ scene: { name: 'pool' } });
    const named = text.replace('{', '{"name": "mine", ');
    expect(readScene(named, 'pool.json')).toMatchObject({ scene: { name: 'mine' } });
  });

  it.each([
    ['{', 'not JSON'],
    ['[]', 'vat.scene/1'],
    ['null', 'vat.scene/1'],
    ['{"format": "else"}', 'vat.scene/1'],
  ])('%s is invalid', (text, words) => {
    expect((readScene(text, 'x.json') as { fault: string }).fault).toContain(words);
  });
});

describe('the state in words', () => {
  const state = {
    isConnected: true,
    isEnded: false,
    hasPicture: true,
    playing: true,
    speed: 1,
    slow: false,
    factor: 1,
    scene: 'Dew',
    people: 1,
    role: 'controller',
    silentSeconds: 0,
  };

  it.each([
    [{}, 'Plays in real time · Dew.'],
    [{ playing: false, people: 3 }, 'Paused · Dew · 3 people here.'],
    [{ speed: 0.5 }, 'Plays at 0.50 × · Dew.'],
    [{ slow: true, factor: 0.97 }, 'Plays in real time · Dew.'],
    [{ reducedError: 0.01 }, 'Plays in real time · Accuracy reduced: error 1 % · Dew.'],
  ])('%o', (change, words) => expect(summarise({ ...state, ...change })).toBe(words));

  it.each([
    [{ slow: true, factor: 0.42 }, 'slow motion, at about 0.4 ×'],
    [{ role: 'viewer' }, 'ask for control'],
    [{ silentSeconds: 4 }, 'No new frame'],
    [{ isConnected: false }, 'continues when the server answers'],
    [{ isConnected: false, isEnded: true }, 'Come back'],
    [{ isConnected: false, hasPicture: false }, 'No frame has arrived'],
  ])('%o is described', (change, words) =>
    expect(summarise({ ...state, ...change })).toContain(words),
  );

  it('does not miss pictures while it is paused', () => {
    expect(summarise({ ...state, playing: false, silentSeconds: 60 })).toBe('Paused · Dew.');
  });

  it.each([
    [{ factor: 0.5 }, true],
    [{ slow: false }, true],
    [{ playing: false }, false],
    [{ speed: 0.5 }, false],
    [{ people: 2 }, false],
    [{ silentSeconds: 4 }, false],
    [{ isConnected: false }, false],
  ])('with %o differs only in the speed: %s', (change, expected) => {
    const slow = { ...state, slow: true, factor: 0.4 };
    expect(onlyPaceDiffers(slow, { ...slow, ...change })).toBe(expected);
  });
});

describe('a link to share', () => {
  const page = 'http://host:8080/?session=s1#invite=old&view=x';

  it('names the session and omits other parameters of the page', () => {
    expect(shareLink(page, { session: 's2' }, {})).toBe('http://host:8080/?session=s2');
  });

  it('carries invitation, camera and view in the fragment, which no request has', () => {
    const link = new URL(
      shareLink(page, { session: 's2' }, { invite: 'abc', pose: kPose, view: 'arrows:true' }),
    );
    expect(link.search).toBe('?session=s2');
    const parts = new URLSearchParams(link.hash.slice(1));
    expect(Object.fromEntries(parts)).toEqual({
      invite: 'abc',
      camera: poseToText(kPose),
      view: 'arrows:true',
    });
  });
});

describe('a link to a moment', () => {
  it('names the recording and the position', () => {
    const page = 'http://host/player/?recording=old.vatrec#at=3';
    const link = new URL(shareLink(page, { recording: 'wave 1.vatrec' }, { moment: 120 }));
    expect(link.searchParams.get('recording')).toBe('wave 1.vatrec');
    expect(link.hash).toBe('#at=120');
    expect(linkedRecording(link.href)).toBe('wave 1.vatrec');
    expect(linkedMoment(link.href)).toBe(120);
  });

  it.each(['', '#at=', '#at=x', '#at=-1', '#at=1.5', '#at=1e3'])('"%s" has no moment', (hash) => {
    expect(linkedMoment(`http://host/${hash}`)).toBeUndefined();
  });
});

describe('rejections of the server, in words', () => {
  const refused = (kind: string, data: object = {}): string =>
    describeError(
      new RequestError(kind, 'method.name: reason', 1, { hint: 'For clients.', ...data }),
    );

  it.each([
    [
      'busy',
      { holder: { participant: 1, name: 'Ada' } },
      'Method.name: reason. Wait until Ada releases it, or use another body.',
    ],
    [
      'rate_limited',
      { retry_after: 1.2 },
      'Method.name: reason. Too many requests. Try again in 2 s.',
    ],
    [
      'limit_reached',
      {},
      'Method.name: reason. Reduce the request, or remove bodies or saved items, and try again.',
    ],
    [
      'timed_out',
      {},
      'The server did not answer. The server is busy, or the connection is slow. Try again.',
    ],
    [
      'not_allowed',
      { role: 'viewer', least_role: 'controller' },
      'Viewers cannot do this. Only controllers can.',
    ],
    ['not_allowed', { role: 'controller', least_role: 'owner' }, 'This needs the role owner.'],
    ['not_allowed', {}, 'Method.name: reason.'],
    ['invalid_params', {}, 'Method.name: reason.'],
  ])('%s names the next action', (kind, data, words) => expect(refused(kind, data)).toBe(words));

  it('lists the faults of a scene', () => {
    const errors = [1, 2, 3, 4].map((n) => ({ code: 'c', path: `/${n}`, message: `m${n}` }));
    const error = new RequestError('invalid_params', 'bad scene', -32602, {
      hint: 'Mend.',
      errors,
    });
    expect(describeError(error)).toBe('Bad scene; /1: m1; /2: m2; /3: m3.');
  });
});
