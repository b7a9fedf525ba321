import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { FrameRecording, RequestError } from '../../../web/client/index';
import type { Event, GridBlock, SessionDescription } from '../../../web/client/index';
import { RecordedSession } from '../../../web/viewer/stream/recorded_session';
import { goldenRecording, sourceIn } from './golden_recording';

/** The frames of the recording are 0.02 s apart. There are four, and every second is a key frame. */
let session: RecordedSession;
let descriptions: SessionDescription[];
let events: Event[];
let ticks: number[];
let epochs: number[];
/** The first coordinate in each frame: 100 in a key frame, 101 in the other ones. */
let places: (number | undefined)[];
let faults: string[];
let drawsAtOnce: boolean;

const now = (): number => Date.now() / 1000;

async function begin(bytes = goldenRecording()): Promise<void> {
  const recording = await FrameRecording.open(sourceIn(bytes));
  session = new RecordedSession(
    recording,
    {
      onDescription: (description) => descriptions.push(description),
      onEvent: (event) => events.push(event),
      onFrame: ({ header, blocks }) => {
        ticks.push(header.tick);
        places.push((blocks[0] as GridBlock).positions[0]);
        epochs.push(header.epoch);
        if (drawsAtOnce) session.acknowledge(header.number);
      },
      onFault: (message) => faults.push(message),
    },
    now,
  );
  session.start();
  await vi.advanceTimersByTimeAsync(0);
}

const pass = (seconds: number): Promise<unknown> => vi.advanceTimersByTimeAsync(1000 * seconds);

beforeEach(() => {
  vi.useFakeTimers({ now: 1_000_000 });
  [descriptions, events, ticks, epochs, places, faults] = [[], [], [], [], [], []];
  drawsAtOnce = true;
});

afterEach(() => {
  session.close();
  vi.useRealTimers();
});

describe('a recording in place of a session', () => {
  it('begins with a description and the first frame', async () => {
    await begin();
    expect(descriptions[0]).toMatchObject({
      session: 'recording',
      name: 'Two particles',
      replay: { begin: 0, end: 3, position: 0 },
    });
    expect([ticks, epochs]).toEqual([[0], [1]]);
    expect(events.at(-1)).toMatchObject({
      event: 'session.status',
      params: { playing: true, position: 0, particles: 2 },
    });
  });

  it('plays in real time, and again from the beginning', async () => {
    await begin();
    await pass(0.061);
    expect(ticks).toEqual([0, 1, 2, 3]);
    expect(descriptions).toHaveLength(1);
    await pass(0.02);
    expect(ticks).toEqual([0, 1, 2, 3, 0]);
    expect(epochs.at(-1)).toBe(2); // the page discards what it has shown
    expect(descriptions.at(-1)).toMatchObject({ epoch: 2, tick: 0 });
  });

  it('ends if it does not loop, and plays again', async () => {
    await begin();
    session.loop(false);
    await pass(1);
    expect(ticks).toEqual([0, 1, 2, 3]);
    expect(events.map(({ event }) => event)).toContain('replay.ended');
    await session.request('control.play', {});
    await pass(0.021);
    expect(ticks).toEqual([0, 1, 2, 3, 0, 1]);
  });

  it('plays at the set speed', async () => {
    await begin();
    await session.request('control.set_speed', { speed: 0.5 });
    await pass(0.041);
    expect(ticks).toEqual([0, 1]);
  });

  it('omits frames if the page draws slowly', async () => {
    await begin();
    await session.request('control.set_speed', { speed: 4 });
    drawsAtOnce = false;
    await pass(0.012);
    expect(ticks).toEqual([0, 1, 2]); // two frames are not acknowledged
    await pass(1);
    session.acknowledge(3);
    await pass(0);
    expect(ticks).toEqual([0, 1, 2, 3]);
  });

  it('pauses, advances by single frames, and seeks', async () => {
    await begin();
    await session.request('control.pause', {});
    await pass(1);
    expect(ticks).toEqual([0]);
    expect(await session.request('control.step', { ticks: 1 })).toMatchObject({ tick: 1 });
    expect(await session.request('replay.seek', { position: 3 })).toMatchObject({ position: 3 });
    expect(await session.request('replay.seek', { position: 2 })).toMatchObject({ position: 2 });
    expect(await session.request('replay.seek', { position: 99 })).toMatchObject({ position: 3 });
    expect(ticks).toEqual([0, 1, 3, 2, 3]);
    expect(places).toEqual([100, 101, 101, 100, 101]);
    expect(await session.request('replay.info', {})).toMatchObject({ playing: false, end: 3 });
    expect(epochs).toEqual([1, 2, 3, 4, 5]);
  });

  it('stops while the page is hidden', async () => {
    await begin();
    session.watch(false);
    await pass(1);
    expect(ticks).toEqual([0]);
    session.watch(true);
    await pass(0.021);
    expect(ticks).toEqual([0, 1]);
  });

  it('rejects all other requests as a page without a connection does', async () => {
    await begin();
    const refusal = session.request('scene.list', {});
    await expect(refusal).rejects.toMatchObject({ kind: 'disconnected' });
    await expect(refusal).rejects.toBeInstanceOf(RequestError);
  });

  it('reports a damaged frame and pauses', async () => {
    const bytes = goldenRecording();
    const indexAt = bytes.length - 16 - (8 + 12 + 4 * 4);
    bytes[indexAt - 1]! ^= 255; // in the last frame
    await begin(bytes);
    await pass(1);
    expect(ticks).toEqual([0, 1, 2]);
    expect(faults).toHaveLength(1);
    expect(events.at(-1)).toMatchObject({ params: { playing: false } });
    expect(await session.request('replay.seek', { position: 1 })).toMatchObject({ position: 1 });
  });
});
