import { once } from 'node:events';
import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { launchChromium } from '../../tests/browser/support/chromium';
import type { DecodeTimes } from './decode_times';

/** Headers with which a page's clock has steps of 5 µs, otherwise 100 µs. */
const kIsolation = {
  'cross-origin-opener-policy': 'same-origin',
  'cross-origin-embedder-policy': 'require-corp',
};

/**
 * Returns the times that the built bench/worker.ts measures for a stream, in a worker as in the
 * viewer.
 */
export async function timesInChromium(
  script: Buffer,
  stream: Buffer,
): Promise<{ version: string; times: DecodeTimes }> {
  const server = createServer((request, response) => {
    const [type, content] =
      request.url === '/worker.js'
        ? ['text/javascript', script]
        : request.url === '/stream'
          ? ['application/octet-stream', stream]
          : ['text/html', '<!doctype html>'];
    response.writeHead(200, { 'content-type': type, ...kIsolation }).end(content);
  });
  server.listen(0, '127.0.0.1');
  await once(server, 'listening');
  const browser = await launchChromium();
  try {
    const page = await browser.newPage();
    await page.goto(`http://127.0.0.1:${(server.address() as AddressInfo).port}/`);
    return { version: browser.version(), times: await page.evaluate(timesInWorker) };
  } finally {
    await browser.close();
    server.close();
  }
}

/** Runs in the browser. */
async function timesInWorker(): Promise<DecodeTimes> {
  if (!crossOriginIsolated) throw new Error('the clock has coarse steps');
  const stream = await (await fetch('/stream')).arrayBuffer();
  const worker = new Worker('/worker.js', { type: 'module' });
  return new Promise((resolve, reject) => {
    worker.onmessage = ({ data }: MessageEvent<DecodeTimes>) => resolve(data);
    worker.onerror = ({ message }) => reject(new Error(message));
    worker.postMessage(stream, [stream]);
  });
}
