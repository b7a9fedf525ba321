import { bytesOfText, restore, sizeOf } from './unpack';
import type { PageParts } from './unpack';

/** Starts the program in an exported page, which contains program and recording as text. */
async function load(): Promise<void> {
  const parts = JSON.parse(document.getElementById('vat-parts')!.textContent!) as PageParts;
  const { program, recording } = restore(await read(parts), parts);
  window.vatRecording = new Blob([recording]);
  const unpacked = new Blob([program]).stream().pipeThrough(new DecompressionStream('gzip'));
  const script = document.createElement('script');
  script.textContent = await new Response(unpacked).text();
  document.body.append(script);
}

/** Returns the data behind the page's markup. */
async function read(parts: PageParts): Promise<Uint8Array<ArrayBuffer>> {
  const holder = document.getElementById('vat-data')!;
  holder.remove();
  const size = sizeOf(parts);
  if (document.characterSet === 'windows-1252') {
    return bytesOfText(textsOf(holder), size);
  }
  // A web server has stated another encoding. Browsers do not fetch files of the disk.
  const whole = new Uint8Array(await (await fetch(location.href)).arrayBuffer());
  return whole.slice(whole.length - size);
}

function* textsOf(holder: Node): Iterable<string> {
  for (let node = holder.firstChild; node; node = holder.firstChild) {
    yield node.nodeValue ?? '';
    node.remove();
  }
}

function fail(error: unknown): void {
  const words = document.getElementById('obstacle')!;
  words.hidden = false;
  words.textContent = `This page cannot be shown: ${String(error)}. It needs a current browser.`;
}

document.addEventListener('DOMContentLoaded', () => void load().catch(fail));
