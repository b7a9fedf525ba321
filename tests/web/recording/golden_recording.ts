import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { RecordingSource } from '../../../web/client/index';
import { checkOf } from '../../../web/client/recording/recording_error';

/** The recording that a test of the C++ writer compares with its output. */
export function goldenRecording(): Uint8Array<ArrayBuffer> {
  const path = fileURLToPath(
    new URL('../../golden/frame_recordings/twice.vatrec', import.meta.url),
  );
  return Uint8Array.from(readFileSync(path));
}

/** A file in memory. Reads outside the file throw an error. */
export function sourceIn(bytes: Uint8Array<ArrayBuffer>): RecordingSource {
  return {
    size: bytes.length,
    read: (offset, length) => {
      if (offset < 0 || offset + length > bytes.length) throw new Error('outside the file');
      return Promise.resolve(bytes.slice(offset, offset + length).buffer);
    },
  };
}

/** Returns the recording with another description, in the place of the only one. */
export function withDescription(text: string): Uint8Array<ArrayBuffer> {
  const whole = goldenRecording();
  const view = new DataView(whole.buffer);
  const indexAt = whole.length - 16 - view.getUint32(whole.length - 16, true);
  const old = view.getUint32(indexAt + 12, true);
  const description = new TextEncoder().encode(text);
  const index = whole.slice(indexAt, whole.length - 16);
  const entry = new DataView(index.buffer);
  entry.setUint32(12, description.length, true);
  entry.setUint32(16, checkOf(description.slice().buffer), true);
  const end = whole.slice(whole.length - 16);
  new DataView(end.buffer).setUint32(4, checkOf(index.buffer), true);
  const frames = whole.subarray(12 + old, indexAt);
  return concat([whole.subarray(0, 12), description, frames, index, end]);
}

export function concat(parts: Uint8Array[]): Uint8Array<ArrayBuffer> {
  const all = new Uint8Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
