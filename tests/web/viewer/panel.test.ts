import { describe, expect, it } from 'vitest';
import type { GuardEvent, SessionDescription } from '../../../web/client/index';
import * as format from '../../../web/viewer/panel/format';
import { lossInWords, qualityInWords } from '../../../web/viewer/panel/status/quality';
import { FrameMeter } from '../../../web/viewer/panel/status/frame_meter';
import { eventInWords } from '../../../web/viewer/panel/event_words';
import { describeGuard } from '../../../web/viewer/panel/notices';
import { sliderSpeed } from '../../../web/viewer/panel/playback';
import { readPoints } from '../../../web/viewer/people/governor_row';
import { chosenSession, givenToken, streamUrl } from '../../../web/viewer/stream/stream';
import { roundLength } from '../../../web/viewer/view/base/ground';

describe('numbers in words', () => {
  it.each([
    [0, '0'],
    [999, '999'],
    [1000, '1\u202f000'],
    [1234567, '1\u202f234\u202f567'],
  ])('count %d', (count, text) => expect(format.formatCount(count)).toBe(text));

  it.each([
    [0, '0 B'],
    [999, '999 B'],
    [17_640, '17.6 kB'],
    [1_234_000, '1.23 MB'],
  ])('%d bytes', (bytes, text) => expect(format.formatBytes(bytes)).toBe(text));

  it.each([
    [0.01, '1 %'],
    [0.00123, '0.12 %'],
    [1.234, '120 %'],
  ])('a relative error of %d', (error, text) => expect(format.formatError(error)).toBe(text));

  it('seconds, milliseconds and factors', () => {
    expect(format.formatSeconds(1.5)).toBe('1.50 s');
    expect(format.formatMilliseconds(0.0126)).toBe('13 ms');
    expect(format.formatFactor(0.999)).toBe('1.00 ×');
  });
});

it.each([
  [{ stride: 1, quantum: 0.002, detail: 3, region: false }, 'every frame, to 1 mm'],
  [
    { stride: 2, quantum: 3.25e-4, detail: 2, region: false },
    'every 2nd frame, to 0.16 mm, half of the particles',
  ],
  [
    { stride: 3, quantum: 1.23e-4, detail: 1, region: true },
    'every 3rd frame, to 62 µm, a quarter of the particles, of a region',
  ],
  [
    { stride: 4, quantum: 1, detail: 0, region: false },
    'every 4th frame, to 500 mm, an eighth of the particles',
  ],
  [{ stride: 11, quantum: 1, detail: 3, region: false }, 'every 11th frame, to 500 mm'],
  [{ stride: 21, quantum: 1, detail: 3, region: false }, 'every 21st frame, to 500 mm'],
])('the content of frames: %o', (header, words) => {
  expect(qualityInWords(header)).toBe(words);
});

it.each([
  [{ stride: 1, detail: 3 }, undefined],
  [{ stride: 4, detail: 3 }, '1 frame in 4'],
  [{ stride: 1, detail: 2 }, '½ of the particles'],
  [{ stride: 4, detail: 0 }, '1 frame in 4, ⅛ of the particles'],
])('the omissions of frames: %o', (header, words) => {
  expect(lossInWords(header)).toBe(words);
});

describe('FrameMeter', () => {
  it('gives the mean over the last two seconds', () => {
    const meter = new FrameMeter();
    for (let i = 0; i <= 100; ++i) meter.add(i / 10, 50);
    expect(meter.bytesPerSecond(10)).toBe(500);
    expect(meter.bytesPerSecond(11)).toBe(250);
    expect(meter.bytesPerSecond(13)).toBe(0);
  });

  it('does not exaggerate the first frame', () => {
    const meter = new FrameMeter();
    expect(meter.bytesPerSecond(5)).toBe(0);
    meter.add(5, 100);
    expect(meter.bytesPerSecond(5)).toBe(400);
    expect(meter.bytesPerSecond(6)).toBe(100);
  });
});

describe('actions of the guard', () => {
  const guard: GuardEvent = {
    tick: 40,
    cause: 'too_fast',
    time: 0.8,
    body: 2,
    particle: 17,
    recovered: true,
  };
  const description = { bodies: [{ body: 2, name: 'pool' }] } as SessionDescription;

  it('names body, time and remedy', () => {
    expect(describeGuard(guard, description)).toBe(
      'At 0.80 s particle 17 of “pool” moved too fast. The step was repeated in smaller parts.',
    );
  });

  it('describes the pause of the session, also for an unknown body', () => {
    const words = describeGuard({ ...guard, body: 9, recovered: false }, description);
    expect(words).toContain('of body 9 moved too fast. The session has paused');
  });
});

describe('a switch of the governor', () => {
  it.each([
    ['behind', 'The server reduces the accuracy to keep up: error 1 %.'],
    ['reserve', 'The server computes more accurately again: error 1 %.'],
  ] as const)('because of %s', (reason, text) => {
    const params = { tick: 1, point: 1, error: 0.01, reason };
    expect(eventInWords({ event: 'governor.switched', params })?.text).toBe(text);
  });
});

describe('the text about a device', () => {
  it('names the feature that it lacks', () => {
    const params = {
      tick: 1,
      code: 'not_on_device',
      path: '/bodies/1/kind',
      message: 'must be liquid on a device',
    } as const;
    expect(eventInWords({ event: 'session.device', params })?.text).toBe(
      'The processor computes in place of the device: must be liquid on a device (/bodies/1/kind).',
    );
  });
});

describe('a file of points for the governor', () => {
  it('is the parameters of session.configure', () => {
    const point = { integrator: 'heun', step: 0.001, error: 0.01, seconds: 0.5 };
    expect(readPoints(JSON.stringify({ governor: [point] }), 'front.json')).toEqual({
      points: [point],
    });
  });

  it.each(['{', 'null', '[]', '{"governor": []}', '{"format": "vat.scene/1"}'])(
    'is not %s',
    (text) => expect(readPoints(text, 'a.json')).toHaveProperty('fault'),
  );
});

describe('sliderSpeed', () => {
  it.each([
    [0, 1],
    [0.1, 1.05],
    [-1, 0.5],
    [2, 4],
    [5, 4],
    [-4.4, 0.05],
    [-9, 0.05],
  ])('position %d is speed %d', (position, speed) => {
    expect(sliderSpeed(position)).toBeCloseTo(speed, 12);
  });

  it('does not push the slider from its place', () => {
    for (let tenth = -43; tenth <= 20; ++tenth) {
      expect(Math.round(10 * Math.log2(sliderSpeed(tenth / 10)))).toBe(tenth);
    }
  });
});

it.each([
  ['http://host:8080/index.html?x', 'ws://host:8080/ws'],
  ['https://host/', 'wss://host/ws'],
])('the stream of %s is %s', (page, url) => expect(streamUrl(page)).toBe(url));

it.each([
  ['http://host/', undefined],
  ['http://host/?session=s2', 's2'],
])('the session of %s is %s', (page, session) => expect(chosenSession(page)).toBe(session));

it.each([
  ['http://host/', undefined],
  ['http://host/?session=s2#ticket=abc', 'abc'],
  ['http://host/#invite=a-_b', 'a-_b'],
  ['http://host/?ticket=abc', undefined],
])('the token of %s is %s', (page, token) => expect(givenToken(page)).toBe(token));

it.each([
  [0.12, 0.1],
  [0.16, 0.2],
  [40, 50],
  [80, 100],
])('a grid near %d has lines every %d', (length, round) => {
  expect(roundLength(length)).toBeCloseTo(round, 12);
});
