import { beforeEach, expect, it } from 'vitest';
import type { Frame } from '../../web/client/index';
import { NewestFrame } from '../../web/viewer/stream/newest_frame';

let acknowledged: number[];
let newest: NewestFrame;

beforeEach(() => {
  acknowledged = [];
  newest = new NewestFrame((number) => acknowledged.push(number));
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

it('says nothing about frames of a subscription that has ended', () => {
  newest.put(frame(7));
  newest.forget();
  expect(newest.take()).toBeUndefined();
  expect(acknowledged).toEqual([]);
});
