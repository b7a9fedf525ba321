import { RequestError } from '../../client/index';
import type { Attributes, Frame, MethodName, Params, Result } from '../../client/index';
import type { FromWorker, ToWorker } from './wire';

/** What the worker reports by itself; replies to requests come as promises instead. */
export type Report =
  | Exclude<FromWorker, { type: 'result' | 'refusal' | 'resume' }>
  /** The worker was not loaded, or has failed. */
  | { type: 'broken' };

export type Request = <M extends MethodName>(method: M, params: Params<M>) => Promise<Result<M>>;

interface Waiting {
  resolve(result: unknown): void;
  reject(error: RequestError): void;
}

const kResumeKey = 'vat.resume';

/** The page's end of the worker that holds the connection. */
export class Stream {
  private readonly worker = new Worker(new URL('./stream.worker.ts', import.meta.url), {
    type: 'module',
  });
  private readonly waiting = new Map<number, Waiting>();
  private lastKey = 0;
  private session: string | undefined;

  constructor(
    /** The address of this page. */
    private readonly page: string,
    private readonly onReport: (report: Report) => void,
  ) {
    this.session = chosenSession(page);
    this.worker.onerror = () => onReport({ type: 'broken' });
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.handle(data);
  }

  /** Connects now; also cuts short the wait before the next attempt. */
  open(): void {
    this.post({
      type: 'open',
      url: streamUrl(this.page),
      session: this.session,
      token: givenToken(this.page),
      resume: sessionStorage.getItem(kResumeKey) ?? undefined,
    });
  }

  /** Takes part in another session; undefined: in the server's first. */
  go(session: string | undefined): void {
    this.session = session;
    this.post({ type: 'go', session });
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

  /** Gives back the memory of a frame, whose columns are gone with that. */
  reuse({ storage }: Frame): void {
    this.post({ type: 'reuse', storage }, [storage]);
  }

  /** Whether frames are wanted; they are from the start. */
  watch(wanted: boolean): void {
    this.post({ type: 'watch', wanted });
  }

  /** Asks for the newest frame once more, whole: it may have been coarse, or of fewer particles. */
  refresh(): void {
    this.post({ type: 'refresh' });
  }

  /** The values of particles that frames are to have, and how exactly; none from the start. */
  askFor(attributes: Attributes): void {
    this.post({ type: 'attributes', attributes });
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
      // Of this tab, so that who reloads the page is who they were.
      sessionStorage.setItem(kResumeKey, message.token);
    } else {
      this.onReport(message);
    }
  }

  private take(key: number): Waiting | undefined {
    const waiting = this.waiting.get(key);
    this.waiting.delete(key);
    return waiting;
  }
}

/** What the fragment of the page's address gives as `#ticket=` or `#invite=`; no request carries it. */
export function givenToken(page: string): string | undefined {
  const given = new URLSearchParams(new URL(page).hash.slice(1));
  return given.get('ticket') ?? given.get('invite') ?? undefined;
}

/** The session that the page's address names with `?session=`. */
export function chosenSession(page: string): string | undefined {
  return new URL(page).searchParams.get('session') ?? undefined;
}

/** The server's WebSocket beside this page. */
export function streamUrl(page: string): string {
  const url = new URL('/ws', page);
  url.protocol = url.protocol === 'https:' ? 'wss:' : 'ws:';
  return url.href;
}
