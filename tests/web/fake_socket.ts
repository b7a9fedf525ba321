import { appendFileSync, mkdirSync } from 'node:fs';
import type { SocketClose } from '../../web/client/index';

interface Sent {
  id?: number;
  method: string;
  params?: Record<string, unknown>;
}

/**
 * Writes what a client sends to the folder that $VAT_TRANSCRIPT names, where what all tests send is
 * checked against the schemas. What comes back is the tests' own, and not checked.
 */
function record(connection: number, sent: string): void {
  const folder = process.env.VAT_TRANSCRIPT;
  if (folder === undefined) return;
  mkdirSync(folder, { recursive: true });
  const line = JSON.stringify({ connection: String(connection), sent });
  appendFileSync(`${folder}/web-${process.pid}.jsonl`, `${line}\n`);
}

let sockets = 0;

/** A WebSocket whose other end is the test. */
export class FakeSocket {
  /** All that were made since `forget`, the newest last. */
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

  /** The line breaks; 1006 is what a browser says where no close frame came. */
  break(close: SocketClose = { code: 1006, reason: '' }): void {
    this.onclose?.(close as never);
  }

  receive(data: unknown): void {
    this.onmessage?.({ data } as never);
  }

  receiveJson(message: object): void {
    this.receive(JSON.stringify({ jsonrpc: '2.0', ...message }));
  }

  /** Methods asked for so far, in order. */
  get methods(): string[] {
    return this.sent.map(({ method }) => method);
  }

  /** Answers the newest request of this method, and lets what waits for it run. */
  async answer(method: string, reply: { result: object } | { error: object }): Promise<void> {
    const request = this.sent.filter((sent) => sent.method === method).at(-1);
    if (request?.id === undefined) throw new Error(`nothing asked for ${method}`);
    this.receiveJson({ id: request.id, ...reply });
    await Promise.resolve();
    await Promise.resolve();
    await Promise.resolve();
  }
}
