/** Sizes of the parts of an exported page [bytes], which `vat export` writes. */
export interface PageParts {
  /** The compressed program. */
  program: number;
  recording: number;
  /** The sizes of the levels of marks. */
  marks: number[];
  /** The marks of the last level, or of the data if there are no levels, in hexadecimal digits. */
  last: string;
}

/** Returns the number of bytes of all parts. */
export function sizeOf({ program, recording, marks }: PageParts): number {
  return marks.reduce((sum, size) => sum + size, program + recording);
}

/**
 * Returns the bytes of a text in windows-1252, at most `count`. The HTML parser replaces zero bytes
 * by U+FFFD, which this encoding does not have.
 */
export function bytesOfText(pieces: Iterable<string>, count: number): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(count);
  const table = byteTable();
  let at = 0;
  for (const piece of pieces) {
    const length = Math.min(piece.length, count - at);
    for (let i = 0; i < length; ++i) bytes[at + i] = table[piece.charCodeAt(i)]!;
    at += length;
  }
  if (at < count) throw new Error(`the page ends early: ${at} of ${count} bytes`);
  return bytes;
}

/**
 * Restores the data of a page: inserts the carriage returns that the page contains as line feeds.
 * The marks have one bit for each line feed. Marks contain carriage returns too, and have marks
 * themselves.
 */
export function restore(
  bytes: Uint8Array<ArrayBuffer>,
  parts: PageParts,
): { program: Uint8Array<ArrayBuffer>; recording: Uint8Array<ArrayBuffer> } {
  const { program, recording, marks, last } = parts;
  let above: Uint8Array = Uint8Array.from(last.match(/../g) ?? [], (digits) =>
    parseInt(digits, 16),
  );
  let end = sizeOf(parts);
  for (const size of [...marks].reverse()) {
    const level = bytes.subarray(end - size, end);
    restoreReturns(level, above);
    above = level;
    end -= size;
  }
  const data = bytes.subarray(0, program + recording);
  restoreReturns(data, above);
  return { program: data.subarray(0, program), recording: data.subarray(program) };
}

function restoreReturns(bytes: Uint8Array, marks: Uint8Array): void {
  let mark = 0;
  for (let at = bytes.indexOf(10); at >= 0; at = bytes.indexOf(10, at + 1)) {
    if ((marks[mark >> 3]! >> (mark & 7)) & 1) bytes[at] = 13;
    ++mark;
  }
}

/** Returns the byte of each UTF-16 unit. */
function byteTable(): Uint8Array {
  const all = new TextDecoder('windows-1252').decode(Uint8Array.from({ length: 256 }, (_, i) => i));
  const table = new Uint8Array(65536);
  for (let byte = 0; byte < 256; ++byte) table[all.charCodeAt(byte)] = byte;
  table[0xfffd] = 0;
  return table;
}
