import { beforeEach, expect, it } from 'vitest';
import type { Frame } from '../../web/client/index';
import { NewestFrame } from '../../web/viewer/stream/newest_frame';

let acknowledged: number[];
let reused: number[];
let newest: NewestFrame;

beforeEach(() => {
  [acknowledged, reused] = [[], []];
  newest = new NewestFrame({
    acknowledge: (number) => acknowledged.push(number),
    reuse: ({ header }) => reused.push(header.number),
  });
});

function frame(number: number): Frame {
  return { header: { number } } as Frame;
}

it('gives the last of several frames, once, and acknowledges it', () => {
  newest.put(frame(1));
  newest.put(frame(2));
  expect(acknowledged).toEqual([]);
  expect(newest.take()).toEqual(frame(2));
  expect(newest.take()).toBeUndefined();
  expect(acknowledged).toEqual([2]);
});

it('gives back each frame once it is not in use any more', () => {
  newest.put(frame(1));
  newest.put(frame(2)); // 1 is never drawn
  expect(reused).toEqual([1]);
  newest.use(newest.take()!);
  newest.put(frame(3));
  expect(reused).toEqual([1]);
  newest.use(newest.take()!);
  expect(reused).toEqual([1, 2]);
  newest.put(frame(4));
  newest.skip();
  newest.put(frame(5));
  newest.forget();
  expect(reused).toEqual([1, 2, 4, 5]);
  expect(acknowledged).toEqual([2, 3, 4]);
});

it('says nothing about frames of a subscription that has ended', () => {
  newest.put(frame(7));
  newest.forget();
  expect(newest.take()).toBeUndefined();
  expect(acknowledged).toEqual([]);
  expect(reused).toEqual([7]);
});
