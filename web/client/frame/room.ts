type Column = Uint16Array<ArrayBuffer> | Uint32Array<ArrayBuffer> | Int32Array<ArrayBuffer>;

interface ColumnType<T extends Column> {
  readonly BYTES_PER_ELEMENT: number;
  new (buffer: ArrayBuffer, offset: number, length: number): T;
}

/** How much more room is made than is needed, so that it need not be made again soon. */
export const kGrowth = 1.5;

/** A column of this length in the room of the old one, if that has enough; zeros where it grew. */
export function fitted<T extends Column>(type: ColumnType<T>, old: T, length: number): T {
  if (old.length === length) return old;
  const size = type.BYTES_PER_ELEMENT;
  if (old.buffer.byteLength >= size * length) return new type(old.buffer, 0, length);
  return new type(new ArrayBuffer(size * Math.ceil(kGrowth * length)), 0, length);
}
