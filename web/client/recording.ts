import { readDescription } from './recorded_description.js';
import { readIndex } from './recording/index_bytes.js';
import type { RecordingIndex } from './recording/index_bytes.js';
import { checkOf, RecordingError } from './recording/recording_error.js';
import type { RecordedScene } from './recorded_description.js';
import type { RecordingSource } from './recording/source.js';

export { isCommandRecording } from './recording/index_bytes.js';
export { RecordingError } from './recording/recording_error.js';
export type { RecordedScene } from './recorded_description.js';
export type { RecordingSource } from './recording/source.js';

/** Frames that are decoded together: a key frame and the frames up to the next one. */
export interface FrameGroup {
  /** The number of the first frame in the recording. */
  first: number;
  frames: ArrayBuffer[];
}

/** The number of stored groups. */
const kStored = 3;

/** A recording of frames: protocol/PROTOCOL.md, "Frame recordings". */
export class FrameRecording {
  private readonly groups = new Map<number, Promise<FrameGroup>>();

  private constructor(
    private readonly source: RecordingSource,
    private readonly index: RecordingIndex,
    /** The descriptions in their order. */
    readonly scenes: readonly RecordedScene[],
  ) {}

  /**
   * Reads the index and all descriptions of a file.
   * @throws RecordingError if the file is invalid.
   */
  static async open(source: RecordingSource): Promise<FrameRecording> {
    const index = await readIndex(source);
    const scenes: RecordedScene[] = [];
    for (const { firstFrame, offset, size, check } of index.descriptions) {
      const bytes = await source.read(offset, size);
      if (checkOf(bytes) !== check) {
        throw new RecordingError('damaged', 'a description of the recording is damaged');
      }
      scenes.push(readDescription(bytes, firstFrame));
    }
    return new FrameRecording(source, index, scenes);
  }

  get frameCount(): number {
    return this.index.sizes.length;
  }

  /** The time between frames [s]. */
  get frameSeconds(): number {
    return this.scenes[0]!.description.tick_seconds;
  }

  /** Returns the description of a frame. */
  sceneAt(frame: number): RecordedScene {
    let d = this.scenes.length - 1;
    while (this.scenes[d]!.firstFrame > frame) --d;
    return this.scenes[d]!;
  }

  /** Returns the last key frame at or before a frame. */
  keyBefore(frame: number): number {
    while (frame > 0 && !this.index.isKey[frame]) --frame;
    return frame;
  }

  /** Returns the group of a frame, and prepares the next group. */
  async group(frame: number): Promise<FrameGroup> {
    const group = await this.load(this.keyBefore(frame));
    const next = group.first + group.frames.length;
    if (next < this.frameCount) void this.load(next).catch(() => undefined); // reported when shown
    return group;
  }

  private load(first: number): Promise<FrameGroup> {
    const known = this.groups.get(first);
    if (known) return known;
    const loaded = this.read(first);
    this.groups.set(first, loaded);
    if (this.groups.size > kStored) this.groups.delete(this.groups.keys().next().value!);
    loaded.catch(() => this.groups.delete(first));
    return loaded;
  }

  private async read(first: number): Promise<FrameGroup> {
    const { sizes, offsets, isKey } = this.index;
    let end = first + 1;
    while (end < sizes.length && !isKey[end]) ++end;
    const begin = offsets[first]!;
    // Descriptions are between groups, because they begin with a key frame.
    const bytes = await this.source.read(begin, offsets[end - 1]! + sizes[end - 1]! - begin);
    const frames: ArrayBuffer[] = [];
    for (let f = first; f < end; ++f) {
      const at = offsets[f]! - begin;
      frames.push(bytes.slice(at, at + sizes[f]!));
    }
    return { first, frames };
  }
}
