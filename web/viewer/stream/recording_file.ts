import { RecordingError } from '../../client/index';
import type { RecordingSource } from '../../client/index';

/** The id of the session of a recording. The ids of a server's sessions have numbers. */
export const kRecordedSession = 'recording';

/** Returns a file in parts. */
export function sourceOf(file: Blob): RecordingSource {
  return {
    size: file.size,
    read: (offset, length) => file.slice(offset, offset + length).arrayBuffer(),
  };
}

/** Returns the address of `?recording=` of the page's address; undefined without one. */
export function linkedRecording(page: string): string | undefined {
  return new URL(page).searchParams.get('recording') ?? undefined;
}

/**
 * Downloads a recording of the page's origin.
 * @throws RecordingError with a message for the user.
 */
export async function download(address: string, page: string): Promise<Blob> {
  let url: URL;
  try {
    url = new URL(address, page);
  } catch {
    throw new RecordingError('other_format', 'its address is not valid');
  }
  if (url.origin !== new URL(page).origin) {
    throw new RecordingError('other_format', 'it must be on the same server as this page');
  }
  let response: Response;
  try {
    response = await fetch(url);
  } catch {
    throw new RecordingError('incomplete', 'the server does not answer');
  }
  if (!response.ok) {
    throw new RecordingError('incomplete', `the server answers with HTTP ${response.status}`);
  }
  try {
    return await response.blob();
  } catch {
    throw new RecordingError('incomplete', 'the connection has ended during the download');
  }
}
