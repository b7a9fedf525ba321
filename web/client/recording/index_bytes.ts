import { checkOf, RecordingError } from './recording_error.js';
import type { RecordingSource } from './source.js';

/** Offsets, sizes and kinds of the parts of a file. */
export interface RecordingIndex {
  descriptions: { firstFrame: number; offset: number; size: number; check: number }[];
  sizes: Uint32Array;
  offsets: Float64Array;
  isKey: Uint8Array;
}

const kMagic = 'vat.frm\n';
const kCommandMagic = 'vat.rec\n';
const kEndMagic = 'vat.end\n';
const kVersion = 1;
const kHeaderBytes = 12;
const kEndBytes = 16;
const kDescriptionEntry = 12;
const kFrameEntry = 4;
const kKeyBit = 0x80000000;
const kMostFrames = 1_000_000;
const kMostDescriptions = 10_000;
/** The size of the header of a frame [bytes]. */
const kLeastFrame = 52;
/** The maximum size of a frame or description [bytes]. */
const kMostBytes = 64 * 1024 * 1024;

/** @throws RecordingError if header or index are invalid. */
export async function readIndex(source: RecordingSource): Promise<RecordingIndex> {
  const { size } = source;
  checkHeader(await source.read(0, Math.min(size, kHeaderBytes)));
  const room = size - kHeaderBytes - kEndBytes;
  if (room < 0) throw incomplete();
  const end = await source.read(size - kEndBytes, kEndBytes);
  const view = new DataView(end);
  const length = view.getUint32(0, true);
  if (textOf(end, 8) !== kEndMagic || length > room) throw incomplete();
  const content = await source.read(size - kEndBytes - length, length);
  if (checkOf(content) !== view.getUint32(4, true)) {
    throw new RecordingError('damaged', 'the index of the recording is damaged');
  }
  const index = readEntries(content);
  if (place(index) !== size - kEndBytes - length) {
    throw bad('the sizes in its index are not those of the file');
  }
  return index;
}

/** Returns whether a file that begins with these bytes is a recording of a session's commands. */
export function isCommandRecording(begin: ArrayBuffer): boolean {
  return begin.byteLength >= 8 && textOf(begin, 0) === kCommandMagic;
}

function checkHeader(header: ArrayBuffer): void {
  if (isCommandRecording(header)) {
    const words = 'the recording contains commands, which only a server can replay';
    throw new RecordingError('commands', words);
  }
  if (header.byteLength < 8 || textOf(header, 0) !== kMagic) {
    throw new RecordingError('other_format', 'the file is not a recording');
  }
  if (header.byteLength < kHeaderBytes) throw incomplete();
  const version = new DataView(header).getUint32(8, true);
  if (version === kVersion) return;
  const words = `the recording has version ${version}, and this page reads version ${kVersion}`;
  throw new RecordingError('other_version', words);
}

function readEntries(content: ArrayBuffer): RecordingIndex {
  const view = new DataView(content);
  if (content.byteLength < 8) throw bad('its index is too short');
  const descriptionCount = view.getUint32(0, true);
  const frameCount = view.getUint32(4, true);
  if (descriptionCount === 0 || descriptionCount > kMostDescriptions) {
    throw bad(`it must have from 1 to ${kMostDescriptions} descriptions`);
  }
  if (frameCount === 0 || frameCount > kMostFrames) {
    throw bad(`it must have from 1 to ${kMostFrames} frames`);
  }
  const framesAt = 8 + kDescriptionEntry * descriptionCount;
  if (content.byteLength !== framesAt + kFrameEntry * frameCount) {
    throw bad('its index must have an entry for each description and each frame');
  }
  const index: RecordingIndex = {
    descriptions: [],
    sizes: new Uint32Array(frameCount),
    offsets: new Float64Array(frameCount),
    isKey: new Uint8Array(frameCount),
  };
  for (let f = 0; f < frameCount; ++f) {
    const entry = view.getUint32(framesAt + kFrameEntry * f, true);
    index.sizes[f] = checkedSize(entry % kKeyBit, kLeastFrame);
    index.isKey[f] = entry >= kKeyBit ? 1 : 0;
  }
  let before = -1;
  for (let d = 0; d < descriptionCount; ++d) {
    const at = 8 + kDescriptionEntry * d;
    const firstFrame = view.getUint32(at, true);
    const isNext = d === 0 ? firstFrame === 0 : firstFrame > before && firstFrame < frameCount;
    if (!isNext || !index.isKey[firstFrame]) {
      throw bad('its descriptions must be in order and begin with a key frame');
    }
    const size = checkedSize(view.getUint32(at + 4, true), 1);
    index.descriptions.push({ firstFrame, offset: 0, size, check: view.getUint32(at + 8, true) });
    before = firstFrame;
  }
  return index;
}

/** Computes all offsets. Returns the end of the last frame. */
function place({ descriptions, sizes, offsets }: RecordingIndex): number {
  let end = kHeaderBytes;
  let d = 0;
  for (let f = 0; f < sizes.length; ++f) {
    const description = descriptions[d];
    if (description?.firstFrame === f) {
      description.offset = end;
      end += description.size;
      ++d;
    }
    offsets[f] = end;
    end += sizes[f]!;
  }
  return end;
}

function checkedSize(size: number, least: number): number {
  if (size >= least && size <= kMostBytes) return size;
  throw bad(`its parts must have from ${least} to ${kMostBytes} bytes`);
}

/** Returns eight characters. */
function textOf(bytes: ArrayBuffer, at: number): string {
  return String.fromCharCode(...new Uint8Array(bytes, at, 8));
}

function incomplete(): RecordingError {
  return new RecordingError('incomplete', 'the recording is incomplete: its end is missing');
}

function bad(words: string): RecordingError {
  return new RecordingError('bad_value', `the recording is invalid: ${words}`);
}
