type Column = Uint16Array<ArrayBuffer> | Uint32Array<ArrayBuffer> | Int32Array<ArrayBuffer>;

interface ColumnType<T extends Column> {
  readonly BYTES_PER_ELEMENT: number;
  new (buffer: ArrayBuffer, offset: number, length: number): T;
}

/** The ratio of allocated to required memory, which makes reallocations rare. */
export const kGrowth = 1.5;

/** Returns a column of this length, in the old memory if it is large enough. New elements are 0. */
export function fitted<T extends Column>(type: ColumnType<T>, old: T, length: number): T {
  if (old.length === length) return old;
  const size = type.BYTES_PER_ELEMENT;
  if (old.buffer.byteLength >= size * length) return new type(old.buffer, 0, length);
  return new type(new ArrayBuffer(size * Math.ceil(kGrowth * length)), 0, length);
}
