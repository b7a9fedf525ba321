/** A file that is read in parts. */
export interface RecordingSource {
  /** The size of the file [bytes]. */
  readonly size: number;
  read(offset: number, length: number): Promise<ArrayBuffer>;
}
