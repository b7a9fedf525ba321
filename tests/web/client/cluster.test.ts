import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import { Session } from '../../../web/client/index';
import { FakeSocket } from '../fake_socket';

const kNodes = ['ws://a/ws', 'ws://b/ws'];
const kDescription = { session: 's1', epoch: 2, scene: 'pool', bodies: [] as object[] };
const kJoined = { resume: 'resume token', description: kDescription };

let session: Session;

beforeEach(() => {
  vi.useFakeTimers();
  FakeSocket.forget();
  const options = { url: 'ws://a/ws', socket: FakeSocket, now: () => 0, retryDelayMs: () => 100 };
  session = new Session(options, {});
  session.open();
});

afterEach(() => {
  session.close();
  vi.useRealTimers();
});

/** Opens the newest socket up to its request to join. */
async function enter(): Promise<FakeSocket> {
  const socket = FakeSocket.newest;
  socket.accept();
  await socket.answer('server.info', { result: { time: 0, nodes: kNodes } });
  return socket;
}

async function enterAndJoin(): Promise<FakeSocket> {
  const socket = await enter();
  await socket.answer('session.join', { result: kJoined });
  await socket.answer('frames.subscribe', { result: { tick: 0 } });
  return socket;
}

function moved(url: string): { error: object } {
  return { error: { code: 1012, message: 'moved', data: { kind: 'moved', session: 's1', url } } };
}

describe('a session of a cluster', () => {
  it('is joined at the node that the error names', async () => {
    await (await enter()).answer('session.join', moved('ws://b/ws'));
    expect(FakeSocket.newest.url).toBe('ws://b/ws');
    const socket = await enterAndJoin();
    expect(socket.methods).toContain('frames.subscribe');
  });

  it('is followed at once with the same token when it moves', async () => {
    const old = await enterAndJoin();
    const params = { session: 's1', url: 'ws://b/ws' };
    old.receiveJson({ method: 'session.moved', params });
    expect(old.closed).toBe(true);
    expect(FakeSocket.newest.url).toBe('ws://b/ws');
    const socket = await enter();
    expect(socket.sent.at(-1)?.params).toEqual({ resume: 'resume token' });
  });

  it('is sought at the other nodes after a break', async () => {
    (await enterAndJoin()).break();
    const urls = new Set<string>();
    for (let i = 0; i < 2; ++i) {
      vi.advanceTimersByTime(100);
      urls.add(FakeSocket.newest.url);
      FakeSocket.newest.break();
    }
    expect([...urls].sort()).toEqual(kNodes);
  });

  it('is not sought without delay between nodes that name each other', async () => {
    for (let i = 0; i < 4; ++i) {
      const to = kNodes[(i + 1) % 2] ?? '';
      await (await enter()).answer('session.join', moved(to));
      expect(FakeSocket.newest.url).toBe(to);
    }
    const before = FakeSocket.made.length;
    await (await enter()).answer('session.join', moved('ws://b/ws'));
    expect(FakeSocket.made.length).toBe(before);
    vi.advanceTimersByTime(100);
    expect(FakeSocket.newest.url).toBe('ws://b/ws');
    expect(FakeSocket.made.length).toBe(before + 1);
  });
});
