import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Connection, defaultRetryDelayMs } from '../../../web/client/index';
import type { ConnectionState, Event } from '../../../web/client/index';
import { FakeSocket } from '../fake_socket';

const kUrl = 'ws://server/ws';
const kTimeoutMs = 1000;

let states: ConnectionState[];
let events: Event[];
let frames: ArrayBuffer[];
let faults: string[];
let connection: Connection;

beforeEach(() => {
  vi.useFakeTimers();
  FakeSocket.forget();
  [states, events, frames, faults] = [[], [], [], []];
  connection = new Connection(
    {
      url: kUrl,
      socket: FakeSocket,
      timeoutMs: kTimeoutMs,
      retryDelayMs: (attempt) => 100 * attempt,
    },
    {
      onState: (state) => states.push(state),
      onEvent: (event) => events.push(event),
      onFrame: (bytes) => frames.push(bytes),
      onFault: (message) => faults.push(message),
    },
  );
});

afterEach(() => {
  connection.close();
  expect(vi.getTimerCount()).toBe(0);
  vi.useRealTimers();
});

function openLine(): FakeSocket {
  connection.open();
  FakeSocket.newest.accept();
  return FakeSocket.newest;
}

describe('states', () => {
  it('asks for the subprotocol and for binary messages as buffers', () => {
    connection.open();
    const { url, protocol, binaryType } = FakeSocket.newest;
    expect({ url, protocol, binaryType }).toEqual({
      url: kUrl,
      protocol: 'vat.v1',
      binaryType: 'arraybuffer',
    });
    expect(states).toEqual([{ name: 'connecting' }]);
  });

  it('is open once the socket is, for as long as it takes', () => {
    openLine();
    vi.advanceTimersByTime(100 * kTimeoutMs);
    expect(states).toEqual([{ name: 'connecting' }, { name: 'open' }]);
  });

  it('waits and reconnects after an interruption', () => {
    openLine().break();
    const waiting = { name: 'waiting', reason: 'the server cannot be reached', retryMs: 100 };
    expect(states.at(-1)).toEqual(waiting);
    vi.advanceTimersByTime(99);
    expect(FakeSocket.made).toHaveLength(1);
    vi.advanceTimersByTime(1);
    expect(FakeSocket.made).toHaveLength(2);
    FakeSocket.newest.accept();
    expect(states.map(({ name }) => name)).toEqual([
      'connecting',
      'open',
      'waiting',
      'connecting',
      'open',
    ]);
  });

  it.each([
    [1001, '', 'the server stops'],
    [1013, '', 'the server has too many connections'],
    [4008, 'queue full', 'this client is too slow: queue full'],
    [4999, '', 'close code 4999'],
  ])('describes close code %i "%s"', (code, reason, words) => {
    openLine().break({ code, reason });
    expect(states.at(-1)).toMatchObject({ name: 'waiting', reason: words });
  });

  it('gives up an attempt that is not answered', () => {
    connection.open();
    vi.advanceTimersByTime(kTimeoutMs);
    expect(states.at(-1)).toMatchObject({ name: 'waiting', reason: 'the server does not answer' });
    expect(FakeSocket.newest.closed).toBe(true);
  });

  it('waits longer after each attempt in a row, and not after the server has spoken', () => {
    openLine().break();
    vi.advanceTimersByTime(100);
    FakeSocket.newest.break();
    expect(states.at(-1)).toMatchObject({ retryMs: 200 });
    vi.advanceTimersByTime(200);
    FakeSocket.newest.accept();
    FakeSocket.newest.receiveJson({ method: 'session.status', params: {} });
    FakeSocket.newest.break();
    expect(states.at(-1)).toMatchObject({ retryMs: 100 });
  });

  it('increases the delay while the server accepts and closes connections immediately', () => {
    openLine().break();
    vi.advanceTimersByTime(100);
    FakeSocket.newest.accept();
    FakeSocket.newest.break();
    expect(states.at(-1)).toMatchObject({ retryMs: 200 });
  });

  it('connects at once when asked to while it waits', () => {
    openLine().break();
    connection.open();
    expect(FakeSocket.made).toHaveLength(2);
    FakeSocket.newest.accept();
    vi.advanceTimersByTime(1000);
    expect(FakeSocket.made).toHaveLength(2);
  });

  it('stays closed', () => {
    const socket = openLine();
    connection.close();
    socket.break();
    vi.advanceTimersByTime(100_000);
    expect(states.at(-1)).toEqual({ name: 'closed' });
    expect(FakeSocket.made).toHaveLength(1);
  });

  it('hears nothing more from a socket that it gave up', () => {
    const old = openLine();
    connection.open();
    old.receiveJson({ method: 'session.status', params: {} });
    expect(events).toEqual([]);
  });

  it('abandons a dead connection on request', () => {
    const socket = openLine();
    connection.restart('no answer');
    expect(socket.closed).toBe(true);
    expect(states.at(-1)).toEqual({ name: 'waiting', reason: 'no answer', retryMs: 100 });
  });
});

describe('a connection that does not open', () => {
  const refused = 'the server does not support vat.v1; reload the page';

  async function breakWithProbe(probe: () => Promise<boolean>): Promise<void> {
    connection = new Connection(
      { url: kUrl, socket: FakeSocket, retryDelayMs: () => 100, probe },
      { onState: (state) => states.push(state) },
    );
    connection.open();
    FakeSocket.newest.break();
    await vi.advanceTimersByTimeAsync(30);
  }
  const after = (ms: number, answer: boolean) => (): Promise<boolean> =>
    new Promise((resolve) => setTimeout(resolve, ms, answer));

  it('is rejected if the server replies without an upgrade, and is tried again as planned', async () => {
    await breakWithProbe(after(30, true));
    expect(states.at(-1)).toEqual({ name: 'waiting', reason: refused, retryMs: 70 });
    await vi.advanceTimersByTimeAsync(69);
    expect(FakeSocket.made).toHaveLength(1);
    await vi.advanceTimersByTimeAsync(1);
    expect(FakeSocket.made).toHaveLength(2);
  });

  it('is unreachable if the server does not reply', async () => {
    await breakWithProbe(after(10, false));
    expect(states.map(({ name }) => name)).toEqual(['connecting', 'waiting']);
    expect(states.at(-1)).toMatchObject({ reason: 'the server cannot be reached' });
  });

  it('is not talked about once the next attempt has begun', async () => {
    await breakWithProbe(after(150, true));
    await vi.advanceTimersByTimeAsync(200);
    expect(states.map(({ name }) => name)).toEqual(['connecting', 'waiting', 'connecting']);
  });

  it('is not asked about once it was open', async () => {
    const probe = vi.fn(after(0, true));
    connection = new Connection({ url: kUrl, socket: FakeSocket, probe }, {});
    openLine().break();
    await vi.advanceTimersByTimeAsync(10);
    expect(probe).not.toHaveBeenCalled();
  });
});

describe('default delay before a retry', () => {
  afterEach(() => vi.restoreAllMocks());

  it.each([
    [0, [500, 1000, 2000, 4000, 8000, 8000]],
    [0.999999, [625, 1250, 2500, 5000, 10000, 10000]],
  ])('doubles up to 8 s, with jitter (random %d)', (random, expected) => {
    vi.spyOn(Math, 'random').mockReturnValue(random);
    const delays = [1, 2, 3, 4, 5, 60].map((attempt) => Math.round(defaultRetryDelayMs(attempt)));
    expect(delays).toEqual(expected);
  });
});

describe('requests', () => {
  it('omits empty params', () => {
    const socket = openLine();
    connection.request('control.play', {}).catch(() => undefined);
    connection.notify('frames.ack', { number: 7 });
    expect(socket.sent).toEqual([
      { jsonrpc: '2.0', id: 1, method: 'control.play' },
      { jsonrpc: '2.0', method: 'frames.ack', params: { number: 7 } },
    ]);
  });

  it('gives each reply to its request, in any order', async () => {
    const socket = openLine();
    const play = connection.request('control.play', {});
    const step = connection.request('control.step', { ticks: 3 });
    socket.receiveJson({ id: 2, result: { tick: 13 } });
    socket.receiveJson({ id: 1, result: { tick: 10 } });
    expect(await play).toEqual({ tick: 10 });
    expect(await step).toEqual({ tick: 13 });
  });

  it('rejects with the error of the server', async () => {
    const socket = openLine();
    const reply = connection.request('world.remove_body', { body: 9 });
    const data = { kind: 'no_such_body', path: '/body' };
    socket.receiveJson({ id: 1, error: { code: 1003, message: 'there is no such body', data } });
    await expect(reply).rejects.toMatchObject({
      kind: 'no_such_body',
      message: 'there is no such body',
      code: 1003,
      data,
    });
  });

  it('rejects if no reply arrives in time, and ignores a late reply', async () => {
    const socket = openLine();
    const reply = connection.request('session.hash', {});
    const rejected = expect(reply).rejects.toMatchObject({
      kind: 'timed_out',
      message: 'session.hash: no answer for 1 s',
    });
    vi.advanceTimersByTime(kTimeoutMs);
    await rejected;
    socket.receiveJson({ id: 1, result: { tick: 1 } });
    expect(faults).toEqual([]);
  });

  it('rejects open requests when the connection breaks', async () => {
    const socket = openLine();
    const reply = connection.request('control.play', {});
    const rejected = expect(reply).rejects.toMatchObject({ kind: 'disconnected' });
    socket.break();
    await rejected;
  });

  it('rejects immediately without a connection', async () => {
    connection.open();
    const reply = connection.request('control.play', {});
    await expect(reply).rejects.toMatchObject({ kind: 'disconnected' });
    expect(FakeSocket.newest.sent).toEqual([]);
  });
});

describe('messages', () => {
  it('hands out events and frames', () => {
    const socket = openLine();
    const bytes = new ArrayBuffer(4);
    socket.receive(bytes);
    socket.receiveJson({ method: 'session.closed', params: { session: 's', reason: 'done' } });
    expect(frames).toEqual([bytes]);
    expect(events).toEqual([{ event: 'session.closed', params: { session: 's', reason: 'done' } }]);
  });

  // Later versions of the server may send them.
  it('ignores unknown events and unknown members', async () => {
    const socket = openLine();
    socket.receiveJson({ method: 'moon.rose', params: { phase: 1 }, source: 'sky' });
    expect(events).toEqual([]);
    const params = { session: 's', reason: 'done', moon: { phase: 1 } };
    socket.receiveJson({ method: 'session.closed', params, source: 'sky' });
    expect(events).toEqual([{ event: 'session.closed', params }]);
    const reply = connection.request('control.pause', {});
    await socket.answer('control.pause', { result: { tick: 3, moon: 'new' } });
    await expect(reply).resolves.toMatchObject({ tick: 3 });
    expect(faults).toEqual([]);
    expect(states.at(-1)).toEqual({ name: 'open' });
  });

  it.each([
    ['text that is not JSON', '{', 'a text message that is not a JSON object'],
    ['a list', '[]', 'a text message that is not a JSON object'],
    ['a refusal without id', '{"id":null,"error":{"code":-32700,"message":"no JSON"}}', 'no JSON'],
    ['a stray reply', '{"id":null,"result":1}', 'a reply without a request'],
    ['other data', 5, 'a message that is neither text nor bytes'],
  ])('reports %s and continues', (_, data, fault) => {
    const socket = openLine();
    socket.receive(data);
    expect(faults).toEqual([fault]);
    expect(states.at(-1)).toEqual({ name: 'open' });
  });
});
