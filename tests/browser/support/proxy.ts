import { createServer } from 'node:http';
import type { ServerResponse } from 'node:http';
import type { AddressInfo } from 'node:net';
import { once } from 'node:events';
import WebSocket, { WebSocketServer } from 'ws';

/** Differences of a server from the real one. */
export interface Ways {
  /** Refuses every WebSocket. */
  refuses?: boolean;
  /** Runs before the script of the page's worker. */
  worker?: string;
  /** Methods that it does not know, as an older server. */
  unknown?: readonly string[];
  /** Its name in a cluster. */
  node?: string;
}

interface Message {
  id?: number;
  method?: string;
  result?: { methods?: string[]; node?: string };
}

/** A proxy between a page and its server. It serves the page, and forwards or holds messages. */
export class Proxy {
  private isFrozen = false;
  private readonly pages = new Set<WebSocket>();
  private readonly http = createServer((request, response) => {
    this.forward(request.url ?? '/', response).catch(() => {
      // The server has ended: the page's request fails too.
      response.destroy();
    });
  });
  private readonly sockets = new WebSocketServer({ noServer: true });

  constructor(
    private readonly server: string,
    private readonly ways: Ways = {},
  ) {
    this.http.on('upgrade', (request, socket, head) => {
      if (ways.refuses) socket.end('HTTP/1.1 400 Bad Request\r\n\r\n');
      else this.sockets.handleUpgrade(request, socket, head, (page) => this.join(page));
    });
  }

  async start(): Promise<string> {
    this.http.listen(0, '127.0.0.1');
    await once(this.http, 'listening');
    return `http://127.0.0.1:${(this.http.address() as AddressInfo).port}/`;
  }

  stop(): void {
    for (const page of this.pages) page.terminate();
    this.sockets.close();
    this.http.close();
  }

  /** Keeps connections open without forwarding messages, including new connections. */
  freeze(frozen: boolean): void {
    this.isFrozen = frozen;
  }

  /** Tells the pages that the server at this address of a page continues their session. */
  moveTo(address: string): void {
    const url = new URL('/ws', address);
    url.protocol = 'ws:';
    const params = { session: 's1', url: String(url) };
    const event = JSON.stringify({ jsonrpc: '2.0', method: 'session.moved', params });
    for (const page of this.pages) page.send(event);
  }

  private async forward(path: string, response: ServerResponse): Promise<void> {
    const answer = await fetch(new URL(path, this.server));
    const headers = ['content-type', 'content-security-policy'].map(
      (name) => [name, answer.headers.get(name) ?? ''] as const,
    );
    const body = Buffer.from(await answer.arrayBuffer());
    const before = Buffer.from(path.includes('stream.worker') ? (this.ways.worker ?? '') : '');
    response.writeHead(answer.status, Object.fromEntries(headers));
    response.end(Buffer.concat([before, body]));
  }

  private join(page: WebSocket): void {
    this.pages.add(page);
    const url = new URL('/ws', this.server);
    url.protocol = 'ws:';
    const line = new WebSocket(url, 'vat.v1');
    const waiting: string[] = [];
    line.on('open', () => waiting.splice(0).forEach((text) => line.send(text)));
    page.on('message', (data) => {
      const text = String(data as Buffer);
      const refusal = this.refusalOf(text);
      if (this.isFrozen) return;
      if (refusal !== undefined) page.send(refusal);
      else if (line.readyState === WebSocket.OPEN) line.send(text);
      else waiting.push(text);
    });
    line.on('message', (data, isBinary) => {
      if (!this.isFrozen) page.send(isBinary ? data : this.changed(String(data as Buffer)));
    });
    page.on('close', () => {
      this.pages.delete(page);
      line.close();
    });
    line.on('close', () => page.close());
    line.on('error', () => page.close());
  }

  /** Returns the reply of a server that does not know the method. */
  private refusalOf(text: string): string | undefined {
    const { id, method } = JSON.parse(text) as Message;
    if (method === undefined || !this.ways.unknown?.includes(method)) return undefined;
    const hint = 'See the methods of server.info.';
    const data = { kind: 'method_not_found', hint };
    const error = { code: -32601, message: `unknown method "${method}"`, data };
    return JSON.stringify({ jsonrpc: '2.0', id, error });
  }

  /** Removes the unknown methods from `server.info`, and adds the node. */
  private changed(text: string): string {
    const message = JSON.parse(text) as Message;
    const { unknown = [], node } = this.ways;
    const methods = message.result?.methods?.filter((method) => !unknown.includes(method));
    if (!methods) return text;
    return JSON.stringify({ ...message, result: { ...message.result, methods, node } });
  }
}
