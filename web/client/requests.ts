import type { ErrorData } from './messages.js';

/** A request that the server rejected or did not answer. */
export class RequestError extends Error {
  constructor(
    /** The error's `data.kind` (PROTOCOL.md), or an error that the client detected. */
    readonly kind: string | 'timed_out' | 'disconnected',
    message: string,
    readonly code?: number,
    readonly data?: ErrorData,
  ) {
    super(message);
    this.name = 'RequestError';
  }
}

interface Waiting {
  resolve(result: unknown): void;
  reject(error: RequestError): void;
  timer: ReturnType<typeof setTimeout>;
}

/** The members of a reply that this class reads. */
export interface Reply {
  id?: unknown;
  result?: unknown;
  error?: { code: number; message: string; data?: ErrorData };
}

/** Pending requests by id. */
export class PendingRequests {
  private readonly waiting = new Map<number, Waiting>();
  private lastId = 0;

  constructor(private readonly timeoutMs: number) {}

  /** Returns a new id, and the promise that its reply settles. */
  add(method: string): { id: number; reply: Promise<unknown> } {
    const id = ++this.lastId;
    const reply = new Promise<unknown>((resolve, reject) => {
      const timer = setTimeout(() => {
        this.waiting.delete(id);
        const seconds = this.timeoutMs / 1000;
        reject(new RequestError('timed_out', `${method}: no answer for ${seconds} s`));
      }, this.timeoutMs);
      this.waiting.set(id, { resolve, reject, timer });
    });
    return { id, reply };
  }

  /** Returns false if no request waits for this reply. */
  settle(reply: Reply): boolean {
    if (typeof reply.id !== 'number') return false;
    const waiting = this.waiting.get(reply.id);
    if (!waiting) return false;
    this.waiting.delete(reply.id);
    clearTimeout(waiting.timer);
    if (reply.error) {
      const { code, message, data } = reply.error;
      waiting.reject(new RequestError(data?.kind ?? 'error', message, code, data));
    } else {
      waiting.resolve(reply.result);
    }
    return true;
  }

  rejectAll(reason: string): void {
    for (const { reject, timer } of this.waiting.values()) {
      clearTimeout(timer);
      reject(new RequestError('disconnected', reason));
    }
    this.waiting.clear();
  }
}
