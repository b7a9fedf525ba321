import { RequestError } from '../../client/index';
import type { Attributes, Frame, MethodName, Params, Result } from '../../client/index';
import type { FromWorker, ToWorker } from './wire';

/** Reports of the worker. Replies to requests settle promises instead. */
export type Report =
  | Exclude<FromWorker, { type: 'result' | 'refusal' | 'resume' }>
  /** The worker could not be loaded or has failed. */
  | { type: 'broken' };

export type Request = <M extends MethodName>(method: M, params: Params<M>) => Promise<Result<M>>;

interface Waiting {
  resolve(result: unknown): void;
  reject(error: RequestError): void;
}

const kResumeKey = 'vat.resume';

/** The server and the session of a stream, and the address that recordings are relative to. */
export interface Place {
  url: string;
  session: string | undefined;
  token: string | undefined;
  base: string;
}

/** Returns the server and the session of a page of the server. */
export function placeOf(page: string): Place {
  return {
    url: streamUrl(page),
    session: chosenSession(page),
    token: givenToken(page),
    base: page,
  };
}

/** The page's interface to the worker that owns the connection. */
export class Stream {
  private readonly worker = new Worker(new URL('./stream.worker.ts', import.meta.url), {
    type: 'module',
  });
  private readonly waiting = new Map<number, Waiting>();
  private lastKey = 0;
  private isRecorded = false;
  private session: string | undefined;

  /** `memory` keeps the token that resumes the participant; without it, a new one joins. */
  constructor(
    private readonly place: Place,
    private readonly onReport: (report: Report) => void,
    private readonly memory?: Pick<Storage, 'getItem' | 'setItem'>,
  ) {
    this.session = place.session;
    this.worker.onerror = () => onReport({ type: 'broken' });
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.handle(data);
  }

  /** Connects now, also during the delay before the next attempt. Ends a recording. */
  open(): void {
    this.isRecorded = false;
    this.post({
      type: 'open',
      url: this.place.url,
      session: this.session,
      token: this.place.token,
      resume: this.memory?.getItem(kResumeKey) ?? undefined,
    });
  }

  /** Joins another session; undefined: the server's first. */
  go(session: string | undefined): void {
    this.session = session;
    if (this.isRecorded) this.open();
    else this.post({ type: 'go', session });
  }

  /** Plays a recording of frames in place of a session: a file, or its address on this server. */
  play(file: Blob | string): void {
    this.post({ type: 'play', file, page: this.place.base });
  }

  /** Selects whether a recording restarts after its end; initially selected. */
  loop(wanted: boolean): void {
    this.post({ type: 'loop', wanted });
  }

  readonly request: Request = (method, params) => {
    const key = ++this.lastKey;
    this.post({ type: 'request', key, method, params });
    return new Promise((resolve, reject) => {
      this.waiting.set(key, { resolve: resolve as Waiting['resolve'], reject });
    });
  };

  acknowledge(number: number): void {
    this.post({ type: 'acknowledge', number });
  }

  /** Returns the memory of a frame to the worker. Its columns become invalid. */
  reuse({ storage }: Frame): void {
    this.post({ type: 'reuse', storage }, [storage]);
  }

  /** Subscribes or unsubscribes; initially subscribed. */
  watch(wanted: boolean): void {
    this.post({ type: 'watch', wanted });
  }

  /** Requests the newest frame in full detail. */
  refresh(): void {
    this.post({ type: 'refresh' });
  }

  /** Selects the attributes in frames and their maximum errors; initially none. */
  askFor(attributes: Attributes): void {
    this.post({ type: 'attributes', attributes });
  }

  /** Ends the connection or the recording for ever. */
  close(): void {
    this.worker.terminate();
  }

  private post(message: ToWorker, transfer: Transferable[] = []): void {
    this.worker.postMessage(message, transfer);
  }

  private handle(message: FromWorker): void {
    if (message.type === 'result') {
      this.take(message.key)?.resolve(message.result);
    } else if (message.type === 'refusal') {
      const { kind, message: text, code, data } = message.refusal;
      this.take(message.key)?.reject(new RequestError(kind, text, code, data));
    } else if (message.type === 'resume') {
      this.memory?.setItem(kResumeKey, message.token);
    } else {
      if (message.type === 'recorded') this.isRecorded = true;
      this.onReport(message);
    }
  }

  private take(key: number): Waiting | undefined {
    const waiting = this.waiting.get(key);
    this.waiting.delete(key);
    return waiting;
  }
}

/** Returns `#ticket=` or `#invite=` of the page's address. Requests do not contain the fragment. */
export function givenToken(page: string): string | undefined {
  const given = new URLSearchParams(new URL(page).hash.slice(1));
  return given.get('ticket') ?? given.get('invite') ?? undefined;
}

/** Returns `?session=` of the page's address. */
export function chosenSession(page: string): string | undefined {
  return new URL(page).searchParams.get('session') ?? undefined;
}

/** Returns the WebSocket address of the page's server. */
export function streamUrl(page: string): string {
  const url = new URL('/ws', page);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  return url.href;
}
