import { appendFileSync, mkdirSync } from 'node:fs';
import type { SocketClose } from '../../web/client/index';

interface Sent {
  id?: number;
  method: string;
  params?: Record<string, unknown>;
}

/**
 * Writes the client's messages to the folder of $VAT_TRANSCRIPT. A later test checks them against
 * the schemas. Replies come from the tests and are not recorded.
 */
function record(connection: number, sent: string): void {
  const folder = process.env.VAT_TRANSCRIPT;
  if (folder === undefined) return;
  mkdirSync(folder, { recursive: true });
  const line = JSON.stringify({ connection: String(connection), sent });
  appendFileSync(`${folder}/web-${process.pid}.jsonl`, `${line}\n`);
}

let sockets = 0;

/** A WebSocket whose peer is the test. */
export class FakeSocket {
  /** All sockets since `forget`, the newest last. */
  static made: FakeSocket[] = [];
  static forget(): void {
    FakeSocket.made = [];
  }
  static get newest(): FakeSocket {
    const socket = FakeSocket.made.at(-1);
    if (!socket) throw new Error('no socket was made');
    return socket;
  }

  binaryType = 'blob';
  onopen: ((event: never) => void) | null = null;
  onclose: ((event: never) => void) | null = null;
  onmessage: ((event: never) => void) | null = null;
  onerror: ((event: never) => void) | null = null;
  readonly sent: Sent[] = [];
  private readonly number = ++sockets;
  closed = false;

  constructor(
    readonly url: string,
    readonly protocol: string,
  ) {
    FakeSocket.made.push(this);
  }

  send(text: string): void {
    record(this.number, text);
    this.sent.push(JSON.parse(text) as Sent);
  }

  close(): void {
    this.closed = true;
  }

  accept(): void {
    this.onopen?.({} as never);
  }

  /** Breaks the connection; 1006 is the browser's code if there was no close frame. */
  break(close: SocketClose = { code: 1006, reason: '' }): void {
    this.onclose?.(close as never);
  }

  receive(data: unknown): void {
    this.onmessage?.({ data } as never);
  }

  receiveJson(message: object): void {
    this.receive(JSON.stringify({ jsonrpc: '2.0', ...message }));
  }

  /** The requested methods in order. */
  get methods(): string[] {
    return this.sent.map(({ method }) => method);
  }

  /** Replies to the newest request of this method, and runs the code that waits for it. */
  async answer(method: string, reply: { result: object } | { error: object }): Promise<void> {
    const request = this.sent.filter((sent) => sent.method === method).at(-1);
    if (request?.id === undefined) throw new Error(`nothing asked for ${method}`);
    this.receiveJson({ id: request.id, ...reply });
    await Promise.resolve();
    await Promise.resolve();
    await Promise.resolve();
  }
}
