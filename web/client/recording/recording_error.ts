export type RecordingErrorCode =
  'other_format' | 'commands' | 'other_version' | 'incomplete' | 'damaged' | 'bad_value';

/** A file that is not a valid recording of frames. The message is a part of a sentence. */
export class RecordingError extends Error {
  constructor(
    readonly code: RecordingErrorCode,
    message: string,
  ) {
    super(message);
    this.name = 'RecordingError';
  }
}

/** The check of bytes in a recording: FNV-1a of 32 bits. */
export function checkOf(buffer: ArrayBuffer): number {
  let check = 2166136261;
  for (const byte of new Uint8Array(buffer)) check = Math.imul(check ^ byte, 16777619);
  return check >>> 0;
}
