import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest';
import type { Vector } from '../../../web/client/index';
import { Held, kRenewal } from '../../../web/viewer/grab/held';
import type { Request } from '../../../web/viewer/stream/stream';

interface Asked {
  method: string;
  params: object;
  resolve(result: object): Promise<void>;
  reject(error: Error): Promise<void>;
}

const kStart = { body: 3, particle: 5, target: [1, 2, 3] as Vector };
let asked: Asked[];
let failures: unknown[];

async function settle(): Promise<void> {
  for (let i = 0; i < 5; ++i) await Promise.resolve();
}

const request: Request = (method, params) =>
  new Promise((resolve, reject) => {
    asked.push({
      method,
      params,
      resolve: (result) => (resolve(result as never), settle()),
      reject: (error) => (reject(error), settle()),
    });
  });

function hold(): Held {
  return new Held(request, kStart, (error) => failures.push(error));
}

beforeEach(() => {
  vi.useFakeTimers();
  [asked, failures] = [[], []];
});

afterEach(() => {
  vi.useRealTimers();
});

describe('Held', () => {
  it('starts, moves and ends the grab that the server named', async () => {
    const held = hold();
    expect(asked).toMatchObject([{ method: 'grab.start', params: kStart }]);
    await asked[0]?.resolve({ grab: 7 });
    held.move([4, 5, 6]);
    expect(asked[1]).toMatchObject({
      method: 'grab.move',
      params: { grab: 7, target: [4, 5, 6] },
    });
    await asked[1]?.resolve({});
    held.end();
    expect(asked[2]).toMatchObject({ method: 'grab.end', params: { grab: 7 } });
  });

  it('sends the newest target only while the server is behind', async () => {
    const held = hold();
    held.move([1, 0, 0]);
    held.move([2, 0, 0]);
    expect(asked).toHaveLength(1);
    await asked[0]?.resolve({ grab: 7 });
    held.move([3, 0, 0]);
    held.move([4, 0, 0]);
    expect(asked).toHaveLength(2);
    expect(asked[1]?.params).toEqual({ grab: 7, target: [2, 0, 0] });
    await asked[1]?.resolve({});
    expect(asked[2]?.params).toEqual({ grab: 7, target: [4, 0, 0] });
  });

  it('reaches the last target before it ends', async () => {
    const held = hold();
    held.move([1, 0, 0]);
    held.end();
    await asked[0]?.resolve({ grab: 7 });
    await asked[1]?.resolve({});
    expect(asked.map(({ method }) => method)).toEqual(['grab.start', 'grab.move', 'grab.end']);
  });

  it('repeats its state periodically until it ends', async () => {
    const held = hold();
    vi.advanceTimersByTime(kRenewal);
    expect(asked).toHaveLength(1);
    await asked[0]?.resolve({ grab: 7 });
    const again = { method: 'grab.move', params: { grab: 7, target: kStart.target } };
    expect(asked[1]).toMatchObject(again);
    await asked[1]?.resolve({});
    vi.advanceTimersByTime(kRenewal);
    expect(asked[2]).toMatchObject(again);
    await asked[2]?.resolve({});
    held.move([4, 5, 6]);
    await asked[3]?.resolve({});
    vi.advanceTimersByTime(kRenewal);
    expect(asked[4]?.params).toEqual({ grab: 7, target: [4, 5, 6] });
    await asked[4]?.resolve({});
    held.end();
    await asked[5]?.resolve({});
    vi.advanceTimersByTime(10 * kRenewal);
    expect(asked).toHaveLength(6);
    expect(vi.getTimerCount()).toBe(0);
  });

  it('is over once the server refuses', async () => {
    const held = hold();
    const error = new Error('no such body');
    await asked[0]?.reject(error);
    expect(vi.getTimerCount()).toBe(0);
    held.move([1, 0, 0]);
    held.end();
    expect(failures).toEqual([error]);
    expect(asked).toHaveLength(1);
  });
});
