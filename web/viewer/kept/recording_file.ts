import { RequestError } from '../../client/index';
import type { Request } from '../stream/stream';

/** Bytes of a part before base64 coding; below the server's message limit. */
const kPartBytes = 256 * 1024;

const kPiece = 8192;

/** The server's size limit [bytes]. */
const kMostBytes = 256 * 1024 * 1024;

/** Returns the reason why a file cannot be a recording, or undefined. The server checks the rest. */
export function faultOfRecording(name: string, size: number): string | undefined {
  if (size === 0) return `“${name}” is empty.`;
  if (size > kMostBytes) return `“${name}” is too large. A recording has at most 256 MiB.`;
  return undefined;
}

/**
 * Sends a recording in parts and returns its number on the server. `tell` receives the share that
 * was sent. Waits after rate limiting; throws other errors.
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

/** Repeats a request while the server limits its rate. */
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

/** Converts in parts, because `btoa` reads characters and calls have a limit of arguments. */
async function toBase64(part: Blob): Promise<string> {
  const bytes = new Uint8Array(await part.arrayBuffer());
  const pieces: string[] = [];
  for (let i = 0; i < bytes.length; i += kPiece) {
    pieces.push(String.fromCharCode(...bytes.subarray(i, i + kPiece)));
  }
  return btoa(pieces.join(''));
}
