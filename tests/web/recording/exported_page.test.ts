import { describe, expect, it } from 'vitest';
import { bytesOfText, restore, sizeOf } from '../../../web/viewer/exported/unpack';
import { pageWith } from '../../../web/scripts/export_page';

/** Returns what an HTML parser makes of bytes in windows-1252. */
function parsed(bytes: Uint8Array): string {
  const text = new TextDecoder('windows-1252').decode(bytes);
  return text.replaceAll('\r', '\n').replaceAll('\0', '\ufffd');
}

describe('the data of an exported page', () => {
  it('are bytes again, of any value', () => {
    const all = Uint8Array.from({ length: 256 }, (_, i) => i);
    const text = parsed(all);
    const bytes = bytesOfText([text.slice(0, 100), text.slice(100)], 256);
    const expected = all.slice();
    expected[13] = 10;
    expect(bytes).toEqual(expected);
  });

  it('may be followed by other characters, but must be complete', () => {
    expect(bytesOfText(['ab', 'cde'], 4)).toEqual(new TextEncoder().encode('abcd'));
    expect(() => bytesOfText(['ab'], 3)).toThrow('2 of 3 bytes');
  });

  it('contain their carriage returns', () => {
    const text = new TextEncoder().encode('a\nb\n\n\nc');
    const parts = { program: 3, recording: 4, marks: [], last: '05' };
    const { program, recording } = restore(Uint8Array.from(text), parts);
    expect(new TextDecoder().decode(program)).toBe('a\rb');
    expect(new TextDecoder().decode(recording)).toBe('\n\r\nc');
  });

  it('have marks with marks', () => {
    // The marks of four line feeds are a carriage return: bits 1, 0, 1, 1.
    const bytes = Uint8Array.from([10, 10, 10, 10, 10]);
    const parts = { program: 0, recording: 4, marks: [1], last: '01' };
    expect(sizeOf(parts)).toBe(5);
    expect([...restore(bytes, parts).recording]).toEqual([13, 10, 13, 13]);
  });
});

describe('the page of an export', () => {
  it('ends where the data begin', () => {
    const page = pageWith('start();');
    expect(page).toContain('<script>start();</script>');
    expect(page.endsWith('<plaintext id="vat-data" hidden>')).toBe(true);
    expect(page.indexOf('charset="windows-1252"')).toBeLessThan(1000);
  });

  it('accepts no loader that ends its element', () => {
    expect(() => pageWith('"</script>"')).toThrow();
    expect(() => pageWith('"ü"')).toThrow();
  });
});
