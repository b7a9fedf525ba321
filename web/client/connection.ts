import { isEventName, kSubprotocol } from './messages.js';
import type { Event, MethodName, Params, Result } from './messages.js';
import { PendingRequests, RequestError } from './requests.js';
import type { Reply } from './requests.js';
import { describeClose, isFinal } from './socket.js';
import type { Socket, SocketClose, SocketConstructor } from './socket.js';

export type ConnectionState =
  | { name: 'connecting' }
  | { name: 'open' }
  /** The line is down; the next attempt comes after `retryMs`. */
  | { name: 'waiting'; reason: string; retryMs: number }
  /** For good: by us, or by the server for the reason that is given. */
  | { name: 'closed'; reason?: string };

export interface ConnectionHandlers {
  onState?(state: ConnectionState): void;
  onEvent?(event: Event): void;
  /** One binary message. */
  onFrame?(bytes: ArrayBuffer): void;
  /** A message that is not of the protocol; the connection goes on. */
  onFault?(message: string): void;
}

export interface ConnectionOptions {
  url: string;
  /** The browser's `WebSocket` or that of the `ws` package. */
  socket: SocketConstructor;
  /**
   * Whether the server answers plain HTTP. Browsers do not say why a line did not open; with this
   * a server that refuses it is told from one that is away.
   */
  probe?: () => Promise<boolean>;
  /** How long a request, or opening the line, may take. */
  timeoutMs?: number;
  /** Delay before the n-th attempt in a row to reconnect, n from 1. */
  retryDelayMs?: (attempt: number) => number;
}

/** 0.5 s, doubled up to 8 s, and up to a quarter more so that clients do not return all at once. */
export function defaultRetryDelayMs(attempt: number): number {
  return Math.min(500 * 2 ** (attempt - 1), 8000) * (1 + Math.random() / 4);
}

const kRefused = `the server does not support ${kSubprotocol}; reload the page`;

/** A line to the server that comes back by itself when it breaks. */
export class Connection {
  private readonly timeoutMs: number;
  private readonly retryDelayMs: (attempt: number) => number;
  private readonly pending: PendingRequests;
  private socket: Socket | undefined;
  private isOpen = false;
  /** To connect since the server last sent something unasked: replies may be refusals to join. */
  private attempts = 0;
  private retryMs = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly options: ConnectionOptions,
    private readonly handlers: ConnectionHandlers,
  ) {
    this.timeoutMs = options.timeoutMs ?? 10_000;
    this.retryDelayMs = options.retryDelayMs ?? defaultRetryDelayMs;
    this.pending = new PendingRequests(this.timeoutMs);
  }

  /** Connects now, whatever the state was before. */
  open(): void {
    this.drop();
    this.handlers.onState?.({ name: 'connecting' });
    const socket = new this.options.socket(this.options.url, kSubprotocol);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.handleOpen();
    socket.onmessage = (event: { data: unknown }) => this.handleMessage(event.data);
    let fault: string | undefined;
    socket.onerror = ({ message }: { message?: string }) => (fault = message);
    socket.onclose = (event: SocketClose) => this.handleClose(event, fault);
    this.socket = socket;
    this.timer = setTimeout(() => this.retryLater('the server does not answer'), this.timeoutMs);
  }

  /** Ends the line and does not come back. */
  close(): void {
    this.drop();
    this.handlers.onState?.({ name: 'closed' });
  }

  /** Gives up a line that is open but dead, and connects anew after a while. */
  restart(reason: string): void {
    if (this.isOpen) this.retryLater(reason);
  }

  /** Rejects with a RequestError if the server refuses, does not answer in time, or is away. */
  async request<M extends MethodName>(method: M, params: Params<M>): Promise<Result<M>> {
    if (!this.isOpen) throw new RequestError('disconnected', `${method}: not connected`);
    const { id, reply } = this.pending.add(method);
    this.send(method, params, id);
    return (await reply) as Result<M>;
  }

  /** Sends without wanting an answer; lost if the line is down. */
  notify<M extends MethodName>(method: M, params: Params<M>): void {
    if (this.isOpen) this.send(method, params);
  }

  private send(method: string, params: object, id?: number): void {
    // JSON.stringify leaves undefined members out: no id in a notification, no empty params.
    const given = Object.keys(params).length > 0 ? params : undefined;
    this.socket?.send(JSON.stringify({ jsonrpc: '2.0', id, method, params: given }));
  }

  private handleOpen(): void {
    clearTimeout(this.timer);
    this.isOpen = true;
    this.handlers.onState?.({ name: 'open' });
  }

  /** `fault`: what Node says of a line that broke; browsers say nothing. */
  private handleClose(event: SocketClose, fault?: string): void {
    const wasOpen = this.isOpen;
    const reason = fault ? `${describeClose(event)}: ${fault}` : describeClose(event);
    if (isFinal(event)) {
      this.drop(reason);
      this.handlers.onState?.({ name: 'closed', reason });
      return;
    }
    this.retryLater(reason);
    if (!wasOpen) void this.explainRefusal();
  }

  /** Corrects the reason for waiting if the server is there. */
  private async explainRefusal(): Promise<void> {
    const { timer } = this;
    const start = Date.now();
    const isThere = await this.options.probe?.();
    if (!isThere || this.timer !== timer) return; // the next attempt has begun already
    const retryMs = Math.max(0, this.retryMs - (Date.now() - start));
    this.handlers.onState?.({ name: 'waiting', reason: kRefused, retryMs });
  }

  private handleMessage(data: unknown): void {
    if (data instanceof ArrayBuffer) {
      this.attempts = 0;
      this.handlers.onFrame?.(data);
    } else if (typeof data === 'string') {
      this.handleText(data);
    } else {
      this.handlers.onFault?.('a message that is neither text nor bytes');
    }
  }

  private handleText(text: string): void {
    const message = parseObject(text);
    if (!message) {
      this.handlers.onFault?.('a text message that is not a JSON object');
    } else if (typeof message.method === 'string') {
      if (isEventName(message.method)) {
        this.attempts = 0;
        this.handlers.onEvent?.({ event: message.method, params: message.params } as Event);
      } else {
        this.handlers.onFault?.(`an unknown event "${message.method}"`);
      }
    } else if (!this.pending.settle(message as Reply)) {
      this.reportStrayReply(message as Reply);
    }
  }

  /** Replies that come after their time-out are stray too, and not worth a word. */
  private reportStrayReply({ id, error }: Reply): void {
    if (typeof id !== 'number') {
      this.handlers.onFault?.(error?.message ?? 'a reply without a request');
    }
  }

  private retryLater(reason: string): void {
    this.drop(reason);
    this.retryMs = this.retryDelayMs(++this.attempts);
    this.timer = setTimeout(() => this.open(), this.retryMs);
    this.handlers.onState?.({ name: 'waiting', reason, retryMs: this.retryMs });
  }

  private drop(reason = 'the connection was closed'): void {
    clearTimeout(this.timer);
    const socket = this.socket;
    this.socket = undefined;
    this.isOpen = false;
    if (socket) {
      socket.onopen = socket.onmessage = socket.onclose = null;
      socket.close();
    }
    this.pending.rejectAll(reason);
  }
}

function parseObject(text: string): Record<string, unknown> | undefined {
  try {
    const value: unknown = JSON.parse(text);
    const isObject = typeof value === 'object' && value !== null && !Array.isArray(value);
    return isObject ? (value as Record<string, unknown>) : undefined;
  } catch {
    return undefined;
  }
}
