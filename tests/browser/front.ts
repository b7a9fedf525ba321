import { createServer } from 'node:http';
import type { AddressInfo } from 'node:net';
import { once } from 'node:events';

/** Hands out a server's page as its own, but refuses its WebSockets. */
export async function startFront(server: string): Promise<{ url: string; stop: () => void }> {
  const front = createServer((request, response) => {
    void fetch(new URL(request.url ?? '/', server)).then(async (answer) => {
      const headers = ['content-type', 'content-security-policy'].map(
        (name) => [name, answer.headers.get(name) ?? ''] as const,
      );
      response.writeHead(answer.status, Object.fromEntries(headers));
      response.end(Buffer.from(await answer.arrayBuffer()));
    });
  });
  front.on('upgrade', (_, socket) => socket.end('HTTP/1.1 400 Bad Request\r\n\r\n'));
  front.listen(0, '127.0.0.1');
  await once(front, 'listening');
  const { port } = front.address() as AddressInfo;
  return { url: `http://127.0.0.1:${port}/`, stop: () => front.close() };
}
