import { isEventName, kSubprotocol } from './messages.js';
import type { Event, MethodName, Params, Result } from './messages.js';
import { PendingRequests, RequestError } from './requests.js';
import type { Reply } from './requests.js';
import { describeClose, isFinal } from './socket.js';
import type { Socket, SocketClose, SocketConstructor } from './socket.js';

export type ConnectionState =
  | { name: 'connecting' }
  | { name: 'open' }
  /** Disconnected; the next attempt follows after `retryMs`. */
  | { name: 'waiting'; reason: string; retryMs: number }
  /** Closed permanently, by the client or by the server with a reason. */
  | { name: 'closed'; reason?: string };

export interface ConnectionHandlers {
  onState?(state: ConnectionState): void;
  onEvent?(event: Event): void;
  /** Receives one binary message. */
  onFrame?(bytes: ArrayBuffer): void;
  /** Reports an invalid message. The connection remains open. */
  onFault?(message: string): void;
}

export interface ConnectionOptions {
  url: string;
  /** The `WebSocket` class of the browser or of the `ws` package. */
  socket: SocketConstructor;
  /**
   * Returns whether the server answers plain HTTP. Browsers do not report why a WebSocket failed to
   * open. The probe distinguishes a refusal from an unreachable server.
   */
  probe?: () => Promise<boolean>;
  /** The time limit of a request and of opening the connection. */
  timeoutMs?: number;
  /** Returns the delay before the n-th successive attempt to reconnect, n from 1. */
  retryDelayMs?: (attempt: number) => number;
}

/** Returns 0.5 s, doubled up to 8 s, plus a random quarter, which spreads the clients' attempts. */
export function defaultRetryDelayMs(attempt: number): number {
  return Math.min(500 * 2 ** (attempt - 1), 8000) * (1 + Math.random() / 4);
}

const kMoved = 'the session moves to another server';
/** The nodes of a cluster may disagree about the owner of a session for some time. */
const kMaxRedirects = 4;
const kRefused = `the server does not support ${kSubprotocol}; reload the page`;

/** A connection to the server that reopens after a failure. */
export class Connection {
  private readonly timeoutMs: number;
  private readonly retryDelayMs: (attempt: number) => number;
  private readonly pending: PendingRequests;
  private socket: Socket | undefined;
  private isOpen = false;
  /** Attempts since the last event or frame. Replies do not count, because they can be refusals to join. */
  private attempts = 0;
  private retryMs = 0;
  /** The URL of the next attempt. */
  private url: string;
  /** The URLs of a cluster's nodes. */
  private nodes: readonly string[] = [];
  private nextNode = 0;
  /** Redirections since the last event or frame. */
  private redirects = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly options: ConnectionOptions,
    private readonly handlers: ConnectionHandlers,
  ) {
    this.url = options.url;
    this.timeoutMs = options.timeoutMs ?? 10_000;
    this.retryDelayMs = options.retryDelayMs ?? defaultRetryDelayMs;
    this.pending = new PendingRequests(this.timeoutMs);
  }

  /** Connects now, from any state. */
  open(): void {
    this.drop();
    this.handlers.onState?.({ name: 'connecting' });
    const socket = new this.options.socket(this.url, kSubprotocol);
    socket.binaryType = 'arraybuffer';
    socket.onopen = () => this.handleOpen();
    socket.onmessage = (event: { data: unknown }) => this.handleMessage(event.data);
    let fault: string | undefined;
    socket.onerror = ({ message }: { message?: string }) => (fault = message);
    socket.onclose = (event: SocketClose) => this.handleClose(event, fault);
    this.socket = socket;
    this.timer = setTimeout(() => this.retryLater('the server does not answer'), this.timeoutMs);
  }

  /** Closes the connection permanently. */
  close(): void {
    this.drop();
    this.handlers.onState?.({ name: 'closed' });
  }

  /** Closes an open connection that does not respond, and reconnects after a delay. */
  restart(reason: string): void {
    if (this.isOpen) this.retryLater(reason);
  }

  /** After the loss of a connection, the client tries these URLs in turn. */
  useNodes(urls: readonly string[]): void {
    this.nodes = urls;
  }

  /** Connects to another URL, at once for the first times. Without a URL, reconnects after a delay. */
  redirect(url: string): void {
    if (url === '') return this.restart(kMoved);
    if (++this.redirects > kMaxRedirects) this.retryLater(kMoved);
    this.url = url; // retryLater() has chosen another one
    if (this.redirects <= kMaxRedirects) this.open();
  }

  /** Rejects with a RequestError if the server refuses, does not reply in time, or is not connected. */
  async request<M extends MethodName>(method: M, params: Params<M>): Promise<Result<M>> {
    if (!this.isOpen) throw new RequestError('disconnected', `${method}: not connected`);
    const { id, reply } = this.pending.add(method);
    this.send(method, params, id);
    return (await reply) as Result<M>;
  }

  /** Sends a notification. It is lost if there is no connection. */
  notify<M extends MethodName>(method: M, params: Params<M>): void {
    if (this.isOpen) this.send(method, params);
  }

  private send(method: string, params: object, id?: number): void {
    // JSON.stringify omits undefined members: the id of a notification, and empty params.
    const given = Object.keys(params).length > 0 ? params : undefined;
    this.socket?.send(JSON.stringify({ jsonrpc: '2.0', id, method, params: given }));
  }

  private handleOpen(): void {
    clearTimeout(this.timer);
    this.isOpen = true;
    this.handlers.onState?.({ name: 'open' });
  }

  /** `fault` is Node's reason for a failure. Browsers give no reason. */
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

  /** Corrects the reported reason if the server is reachable. */
  private async explainRefusal(): Promise<void> {
    const { timer } = this;
    const start = Date.now();
    const isThere = await this.options.probe?.();
    if (!isThere || this.timer !== timer) return; // the next attempt has begun
    const retryMs = Math.max(0, this.retryMs - (Date.now() - start));
    this.handlers.onState?.({ name: 'waiting', reason: kRefused, retryMs });
  }

  private handleMessage(data: unknown): void {
    if (data instanceof ArrayBuffer) {
      this.attempts = this.redirects = 0;
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
      if (!isEventName(message.method)) return; // an event of a later version
      this.attempts = 0;
      if (message.method !== 'session.moved') this.redirects = 0;
      this.handlers.onEvent?.({ event: message.method, params: message.params } as Event);
    } else if (!this.pending.settle(message as Reply)) {
      this.reportStrayReply(message as Reply);
    }
  }

  /** Ignores replies with an id, because they can be late replies of timed-out requests. */
  private reportStrayReply({ id, error }: Reply): void {
    if (typeof id !== 'number') {
      this.handlers.onFault?.(error?.message ?? 'a reply without a request');
    }
  }

  private retryLater(reason: string): void {
    this.drop(reason);
    this.retryMs = this.retryDelayMs(++this.attempts);
    if (this.nodes.length > 1)
      this.url = this.nodes[this.nextNode++ % this.nodes.length] ?? this.url;
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
