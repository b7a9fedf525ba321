import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { emptyFrame, Session } from '../../../web/client/index';
import type { Frame, SessionDescription, SessionOptions } from '../../../web/client/index';
import { FakeSocket } from '../fake_socket';
import { goldenBytes } from '../golden';

const kDescription = { session: 's1', epoch: 2, scene: 'pool', bodies: [] as object[] };

let descriptions: SessionDescription[];
let frames: { frame: Frame; bytes: number }[];
let offsets: number[];
let states: string[];
let faults: string[];
let seconds: number;
let session: Session;

function newSession(options: Partial<SessionOptions> = {}, frameFor?: () => Frame): Session {
  return new Session(
    {
      url: 'ws://server/ws',
      socket: FakeSocket,
      now: () => seconds,
      timeoutMs: 1000,
      clockPeriodMs: 5000,
      retryDelayMs: () => 100,
      ...options,
    },
    {
      onState: ({ name }) => states.push(name),
      onDescription: (description) => descriptions.push(description),
      onFrame: (frame, bytes) => frames.push({ frame, bytes }),
      onClockOffset: (offset) => offsets.push(offset),
      onFault: (message) => faults.push(message),
      ...(frameFor && { frameFor }),
    },
  );
}

beforeEach(() => {
  vi.useFakeTimers();
  FakeSocket.forget();
  [descriptions, frames, offsets, states, faults] = [[], [], [], [], []];
  seconds = 50;
  session = newSession();
});

afterEach(() => {
  session.close();
  expect(vi.getTimerCount()).toBe(0);
  vi.useRealTimers();
});

/** Opens the newest socket and replies to the requests up to the join. */
async function join(description: object = kDescription): Promise<FakeSocket> {
  const socket = FakeSocket.newest;
  socket.accept();
  await socket.answer('server.info', { result: { time: 1050 } });
  await socket.answer('session.join', { result: { description } });
  return socket;
}

/** Replies to all requests of a session's start. */
async function enter(): Promise<FakeSocket> {
  const socket = await join();
  await socket.answer('frames.subscribe', { result: { tick: 0 } });
  return socket;
}

function openSession(): Promise<FakeSocket> {
  session.open();
  return enter();
}

describe('the error of positions', () => {
  const kBody = { body: 1, name: 'a', kind: 'liquid', material: 'water', particles: 1 } as const;
  const described = (...radii: number[]): typeof kDescription => ({
    ...kDescription,
    bodies: radii.map((radius) => ({ ...kBody, radius })),
  });

  it('is a fraction of the smallest radius, and is requested again if the radius changes', async () => {
    session = newSession({ errorInRadii: 0.5 });
    session.open();
    const socket = await join(described(0.4, 0.2));
    const subscriptions = () =>
      socket.sent.flatMap((m) => (m.method === 'frames.subscribe' ? [m.params] : []));
    expect(subscriptions()).toEqual([{ max_error: 0.1 }]);
    await socket.answer('frames.subscribe', { result: { tick: 0 } });
    const tell = (description: typeof kDescription) =>
      socket.receiveJson({ method: 'session.description', params: description });
    tell(described(0.2, 0.3));
    expect(subscriptions()).toHaveLength(1);
    tell(described(0.6));
    tell(described());
    expect(subscriptions().slice(1)).toEqual([{ max_error: 0.3 }, undefined]);
  });
});

describe('the level of detail', () => {
  const subscribed = async (bodies: object[]): Promise<unknown> => {
    session = newSession({ mostParticles: 1000 });
    session.open();
    const socket = await join({ ...kDescription, bodies });
    return socket.sent.find((message) => message.method === 'frames.subscribe')?.params;
  };
  const body = (kind: string, particles: number) => ({ kind, particles, radius: 1 });

  it.each([
    [1000, undefined],
    [1001, { detail: 2 }],
    [2001, { detail: 1 }],
    [4001, { detail: 0 }],
    [100_000, { detail: 0 }],
  ])('of %i particles has at most the given number', async (particles, params) => {
    expect(await subscribed([body('liquid', particles)])).toEqual(params);
  });

  it('does not count the particles of rigid bodies, of which frames have the positions', async () => {
    const params = await subscribed([
      body('liquid', 500),
      body('deformable', 501),
      body('rigid', 5000),
    ]);
    expect(params).toEqual({ detail: 2 });
  });
});

describe('a server that asks for a token', () => {
  const kToken = 'a'.repeat(22);
  const kResume = 'b'.repeat(22);
  const refusal = {
    error: { code: 1007, message: 'no', data: { kind: 'not_authenticated', hint: 'ask' } },
  };
  const joined = { result: { description: kDescription, resume: kResume } };
  const shown = (socket: FakeSocket) =>
    socket.sent.flatMap((m) => (m.method === 'access.enter' ? [m.params] : []));

  async function knock(): Promise<FakeSocket> {
    const socket = FakeSocket.newest;
    socket.accept();
    await socket.answer('server.info', { result: { time: 1050, access: 'token' } });
    return socket;
  }

  it('is shown the one that was given, and after a break the one to come back with', async () => {
    session = newSession({ token: kToken });
    session.open();
    const socket = await knock();
    expect(shown(socket)).toEqual([{ token: kToken }]);
    await socket.answer('access.enter', { result: { role: 'controller' } });
    await socket.answer('session.join', joined);
    await socket.answer('frames.subscribe', { result: { tick: 0 } });
    socket.break();
    vi.advanceTimersByTime(100);
    const second = await knock();
    expect(shown(second)).toEqual([{ token: kResume }]);
    await second.answer('access.enter', { result: { role: 'controller' } });
    expect(second.sent.at(-1)).toMatchObject({
      method: 'session.join',
      params: { resume: kResume },
    });
    await second.answer('session.join', joined);
    expect(descriptions).toHaveLength(2);
  });

  it('receives the given token if the identity is forgotten', async () => {
    session = newSession({ token: kToken, resume: kResume });
    session.open();
    const socket = await knock();
    await socket.answer('access.enter', refusal);
    expect(shown(socket)).toEqual([{ token: kResume }, { token: kToken }]);
    await socket.answer('access.enter', { result: { role: 'viewer' } });
    await socket.answer('session.join', joined);
    expect(descriptions).toHaveLength(1);
  });

  it('is described in words if there is no token', async () => {
    session.open();
    const socket = await knock();
    expect(shown(socket)).toEqual([]);
    expect(socket.methods).toEqual(['server.info']);
    expect(states.at(-1)).toBe('waiting');
  });

  it.each([4003, 4010])('is not contacted again after close code %i', async (code) => {
    const socket = await openSession();
    socket.break({ code, reason: '' });
    expect(states.at(-1)).toBe('closed');
    vi.advanceTimersByTime(100_000);
    expect(FakeSocket.made).toHaveLength(1);
  });
});

describe('entering', () => {
  const kMethods = ['server.info', 'session.join', 'frames.subscribe'];

  it('measures the clock, joins and subscribes, and does so again after a break', async () => {
    const socket = await openSession();
    expect(socket.methods).toEqual(kMethods);
    expect(offsets).toEqual([1000]);
    expect(descriptions).toEqual([kDescription]);
    socket.break();
    vi.advanceTimersByTime(100);
    expect((await enter()).methods).toEqual(kMethods);
    expect(states).toEqual(['connecting', 'open', 'waiting', 'connecting', 'open']);
    expect(descriptions).toHaveLength(2);
  });

  it.each([
    [undefined, undefined],
    ['s7', { session: 's7' }],
  ])('joins session %s', async (chosen, params) => {
    session = newSession({ session: chosen });
    const socket = await openSession();
    expect(socket.sent.find(({ method }) => method === 'session.join')?.params).toEqual(params);
  });

  it('uses a new connection if the server rejects the join', async () => {
    session.open();
    const socket = FakeSocket.newest;
    socket.accept();
    await socket.answer('server.info', { result: { time: 1050 } });
    const error = { code: 1002, message: 'there is no session', data: { kind: 'no_such_session' } };
    await socket.answer('session.join', { error });
    expect(states.at(-1)).toBe('waiting');
    expect(socket.closed).toBe(true);
    vi.advanceTimersByTime(100);
    await enter();
    expect(descriptions).toHaveLength(1);
  });

  it('joins again when its session is closed', async () => {
    const socket = await openSession();
    const params = { session: 's1', reason: 'closed by a client' };
    socket.receiveJson({ method: 'session.closed', params });
    await socket.answer('server.info', { result: { time: 1050 } });
    await socket.answer('session.join', { result: { description: kDescription } });
    expect(descriptions).toHaveLength(2);
  });
});

describe('while it is in', () => {
  it('takes each new description', async () => {
    const socket = await openSession();
    socket.receiveJson({ method: 'session.description', params: { ...kDescription, epoch: 3 } });
    expect(descriptions.map(({ epoch }) => epoch)).toEqual([2, 3]);
  });

  it('decodes frames and acknowledges them on request', async () => {
    const socket = await openSession();
    const bytes = goldenBytes('v2-key');
    socket.receive(bytes);
    expect(frames).toHaveLength(1);
    expect(frames[0]?.bytes).toBe(bytes.byteLength);
    expect(socket.methods).not.toContain('frames.ack');
    session.acknowledge(frames[0]?.frame.header.number ?? 0);
    expect(socket.sent.at(-1)).toMatchObject({ method: 'frames.ack', params: { number: 10 } });
    expect(socket.sent.at(-1)).not.toHaveProperty('id');
  });

  it('reports an invalid frame, requests a key frame and continues', async () => {
    const socket = await openSession();
    socket.receive(new ArrayBuffer(10));
    expect(faults).toEqual([expect.stringContaining('(truncated)')]);
    expect(socket.methods.slice(3)).toEqual(['frames.subscribe']);
    socket.receive(goldenBytes('v2-empty'));
    expect(frames).toHaveLength(1);
  });

  it('names the frame that is missing, once, and takes the next key frame', async () => {
    const socket = await openSession();
    socket.receive(goldenBytes('v2-delta-one'));
    expect(faults).toEqual([expect.stringMatching(/missing_reference.*frame 10 is not stored/)]);
    socket.receive(goldenBytes('v2-delta-two'));
    expect(faults).toHaveLength(1);
    const acknowledged = { method: 'frames.ack' }; // frees the server's window
    expect(socket.sent.slice(3)).toMatchObject([
      { ...acknowledged, params: { number: 12, rejected: true } },
      { ...acknowledged, params: { number: 13 } },
    ]);
    expect(socket.sent.at(-1)?.params).not.toHaveProperty('rejected');
    socket.receive(goldenBytes('v2-key'));
    socket.receive(goldenBytes('v2-delta-one'));
    expect(frames.map(({ frame }) => frame.header.number)).toEqual([10, 12]);
    socket.receive(goldenBytes('v2-dropped')); // refers to other frames
    expect(faults).toHaveLength(2);
  });

  it('uses a new connection if the key frame is invalid too', async () => {
    const socket = await openSession();
    socket.receive(new ArrayBuffer(10));
    socket.receive(new ArrayBuffer(10));
    expect(states.at(-1)).toBe('waiting');
  });

  it('decodes to the frame that it is given', async () => {
    const given = emptyFrame();
    session = newSession({}, () => given);
    const socket = await openSession();
    socket.receive(goldenBytes('v2-key'));
    expect(frames.map(({ frame }) => frame)).toEqual([given]);
    expect(given.header.number).toBe(10);
  });

  it('requests no frames while the page is hidden', async () => {
    const socket = await openSession();
    session.watch(false);
    session.watch(false);
    expect(socket.methods.slice(3)).toEqual(['frames.unsubscribe']);
    await socket.answer('frames.unsubscribe', { result: { tick: 1 } });
    session.watch(true);
    expect(socket.methods.slice(3)).toEqual(['frames.unsubscribe', 'frames.subscribe']);
  });

  it('joins without a subscription while the page is hidden, and subscribes later', async () => {
    session.watch(false);
    session.open();
    const socket = await join();
    expect(socket.methods).toEqual(['server.info', 'session.join']);
    session.watch(true);
    expect(socket.methods).toEqual(['server.info', 'session.join', 'frames.subscribe']);
  });

  it('measures the clock again and again', async () => {
    const socket = await openSession();
    vi.advanceTimersByTime(5000);
    expect(socket.methods.filter((method) => method === 'server.info')).toHaveLength(2);
  });

  it('abandons a connection without replies', async () => {
    session.open();
    await enter();
    vi.advanceTimersByTime(5000);
    await vi.advanceTimersByTimeAsync(1000);
    expect(states.at(-1)).toBe('waiting');
  });
});

describe('going to another session', () => {
  it('joins it over the same connection as a new participant, and rejoins after an interruption', async () => {
    session = newSession({ resume: 'a'.repeat(22) });
    const socket = await openSession();
    session.go('r1');
    expect(socket.sent.at(-1)).toMatchObject({
      method: 'session.join',
      params: { session: 'r1' },
    });
    expect(socket.sent.at(-1)).not.toHaveProperty('params.resume');
    await socket.answer('session.join', {
      result: { description: { ...kDescription, session: 'r1' }, resume: 'b'.repeat(22) },
    });
    expect(descriptions.map(({ session: name }) => name)).toEqual(['s1', 'r1']);
    expect(socket.methods.slice(-2)).toEqual(['session.join', 'frames.subscribe']);
    await socket.answer('frames.subscribe', { result: { tick: 0 } });
    socket.break();
    vi.advanceTimersByTime(100);
    const second = await join();
    expect(second.sent.find(({ method }) => method === 'session.join')?.params).toEqual({
      session: 'r1',
      resume: 'b'.repeat(22),
    });
  });

  it('passes over the answer of one that it has gone on from', async () => {
    session = newSession();
    const socket = await openSession();
    session.go('r1');
    session.go('r2');
    const joined = (name: string) => ({
      result: { description: { ...kDescription, session: name } },
    });
    const requests = socket.sent.filter(({ params }) => params?.session !== undefined);
    for (const [n, name] of ['r1', 'r2'].entries()) {
      socket.receiveJson({ id: requests[n]?.id, ...joined(name) });
      await socket.answer('server.info', { result: { time: 1050 } }); // the session reads the reply
    }
    expect(descriptions.map(({ session: name }) => name)).toEqual(['s1', 'r2']);
  });
});
