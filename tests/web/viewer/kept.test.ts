import { afterEach, describe, expect, it, vi } from 'vitest';
import { RequestError } from '../../../web/client/index';
import { faultOfRecording, sendRecording } from '../../../web/viewer/kept/recording_file';
import { addressOf } from '../../../web/viewer/stream/address';
import { Newest } from '../../../web/viewer/stream/newest';
import type { Request } from '../../../web/viewer/stream/stream';

afterEach(() => vi.useRealTimers());

describe('Newest', () => {
  it('sends one after another, and of those that came meanwhile the last', async () => {
    const sent: number[] = [];
    const answers: (() => void)[] = [];
    const newest = new Newest((value: number) => {
      sent.push(value);
      return new Promise<void>((resolve) => answers.push(resolve));
    });
    for (const value of [1, 2, 3]) newest.put(value);
    expect(sent).toEqual([1]);
    answers.shift()!();
    await vi.waitFor(() => expect(sent).toEqual([1, 3]));
    expect(newest.isBusy).toBe(true);
    answers.shift()!();
    await vi.waitFor(() => expect(newest.isBusy).toBe(false));
    newest.put(4);
    expect(sent).toEqual([1, 3, 4]);
  });
});

describe('the address of a session', () => {
  it.each([
    ['http://a/?session=s1#view=liquid:splats', 'r2', 'http://a/?session=r2#view=liquid:splats'],
    ['http://a/?session=r1', undefined, 'http://a/'],
    ['http://a/', 'r1', 'http://a/?session=r1'],
  ])('%s, %s', (page, session, address) => expect(addressOf(page, session)).toBe(address));
});

describe('recordings from files', () => {
  it.each([
    [0, 'empty'],
    [256 * 1024 * 1024 + 1, 'too large'],
  ])('of %d bytes are refused', (size, words) => {
    expect(faultOfRecording('a.vatrec', size)).toContain(words);
  });

  it('of any other size are not', () => {
    expect(faultOfRecording('a.vatrec', 1)).toBeUndefined();
    expect(faultOfRecording('a.vatrec', 256 * 1024 * 1024)).toBeUndefined();
  });

  it('are sent in parts, and wait if the server requests it', async () => {
    const bytes = Uint8Array.from({ length: 600_000 }, (_, i) => (i * 7919) % 251);
    const parts: { offset: number; recording?: string; data: string }[] = [];
    let isSoon = true;
    const request = ((_: string, part: (typeof parts)[number]) => {
      if (parts.length === 1 && isSoon) {
        isSoon = false;
        const data = { kind: 'rate_limited', retry_after: 1.5 } as const;
        return Promise.reject(new RequestError('rate_limited', 'too soon', 1009, data));
      }
      parts.push(part);
      const received = part.offset + Buffer.from(part.data, 'base64').length;
      return Promise.resolve({ recording: 'x', received, whole: received === bytes.length });
    }) as unknown as Request;
    const shares: number[] = [];
    vi.useFakeTimers({ toFake: ['setTimeout', 'clearTimeout'] });
    const sending = sendRecording(new Blob([bytes]), request, (share) => shares.push(share));
    while (vi.getTimerCount() === 0) await new Promise((resolve) => setImmediate(resolve));
    await vi.advanceTimersByTimeAsync(1499);
    expect(parts).toHaveLength(1);
    await vi.advanceTimersByTimeAsync(1);
    expect(await sending).toBe('x');
    const whole = Buffer.concat(parts.map(({ data }) => Buffer.from(data, 'base64')));
    expect(whole.equals(Buffer.from(bytes))).toBe(true);
    expect(parts.map(({ recording }) => recording)).toEqual([undefined, 'x', 'x']);
    expect(shares.at(-1)).toBe(1);
  });
});
