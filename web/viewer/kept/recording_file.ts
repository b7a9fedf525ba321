import { RequestError } from '../../client/index';
import type { Request } from '../stream/stream';

/** Of a file, before it is written in base64: well within what a server takes in one message. */
const kPartBytes = 256 * 1024;

const kPiece = 8192;

/** What a server takes in all [bytes]. */
const kMostBytes = 256 * 1024 * 1024;

/** Why a file is no recording, in words; undefined where it may be one: the server looks closer. */
export function faultOfRecording(name: string, size: number): string | undefined {
  if (size === 0) return `“${name}” is empty.`;
  if (size > kMostBytes) return `“${name}” is too large. A recording has at most 256 MiB.`;
  return undefined;
}

/**
 * Sends a recording part by part and tells its number on the server; `tell` hears which share is
 * there. Waits where the server asks for it, and throws what it refuses.
 */
export async function sendRecording(
  file: Blob,
  request: Request,
  tell: (share: number) => void,
): Promise<string> {
  let recording: string | undefined;
  for (let offset = 0; offset < file.size; offset += kPartBytes) {
    const data = await toBase64(file.slice(offset, offset + kPartBytes));
    const part = { size: file.size, offset, data, ...(recording !== undefined && { recording }) };
    const answer = await patiently(() => request('recording.import', part));
    recording = answer.recording;
    tell(answer.received / file.size);
  }
  if (recording === undefined) throw new Error('the file is empty');
  return recording;
}

/** Asks again for as long as the server says that it comes too soon. */
async function patiently<T>(act: () => Promise<T>): Promise<T> {
  for (;;) {
    try {
      return await act();
    } catch (error) {
      if (!(error instanceof RequestError) || error.kind !== 'rate_limited') throw error;
      const seconds = error.data?.retry_after ?? 1;
      await new Promise((resolve) => setTimeout(resolve, 1000 * seconds));
    }
  }
}

/** `btoa` takes characters for bytes, and a call has only so many arguments. */
async function toBase64(part: Blob): Promise<string> {
  const bytes = new Uint8Array(await part.arrayBuffer());
  const pieces: string[] = [];
  for (let i = 0; i < bytes.length; i += kPiece) {
    pieces.push(String.fromCharCode(...bytes.subarray(i, i + kPiece)));
  }
  return btoa(pieces.join(''));
}
