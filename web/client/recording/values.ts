import { RecordingError } from './recording_error.js';

/** Functions that check a value of a file. They throw RecordingError with the name of the value. */

const kMostText = 4096;

export function objectOf(value: unknown, name: string): Record<string, unknown> {
  if (typeof value === 'object' && value !== null && !Array.isArray(value)) {
    return value as Record<string, unknown>;
  }
  throw bad(name, 'an object');
}

export function listOf(value: unknown, name: string, most: number): unknown[] {
  if (Array.isArray(value) && value.length <= most) return value as unknown[];
  throw bad(name, `a list of at most ${most} values`);
}

export function numbersOf(value: unknown, name: string, most: number): number[] {
  return listOf(value, name, most).map((one) => numberOf(one, name, -1e9, 1e9));
}

export function vectorOf(value: unknown, name: string): [number, number, number] {
  const [x, y, z, more] = numbersOf(value, name, 3);
  if (x === undefined || y === undefined || z === undefined || more !== undefined) {
    throw bad(name, 'three numbers');
  }
  return [x, y, z];
}

export function textOf(value: unknown, name: string): string {
  if (typeof value === 'string' && value.length <= kMostText) return value;
  throw bad(name, `a text of at most ${kMostText} characters`);
}

export function numberOf(value: unknown, name: string, min: number, max: number): number {
  if (typeof value === 'number' && value >= min && value <= max) return value;
  throw bad(name, `a number from ${min} to ${max}`);
}

export function countOf(value: unknown, name: string): number {
  const count = numberOf(value, name, 0, 2 ** 32 - 1);
  if (Number.isInteger(count)) return count;
  throw bad(name, 'a whole number');
}

export function choiceOf<T extends string>(value: unknown, name: string, all: readonly T[]): T {
  const choice = all.find((one) => one === value);
  if (choice !== undefined) return choice;
  throw bad(name, `one of ${all.join(', ')}`);
}

export function bad(name: string, kind: string): RecordingError {
  return new RecordingError('bad_value', `the recording is invalid: ${name} must be ${kind}`);
}
