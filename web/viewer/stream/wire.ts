import type {
  Attributes,
  ConnectionState,
  ErrorData,
  Event,
  Frame,
  JoinedAs,
  MethodName,
  SessionDescription,
} from '../../client/index';

/** The server's address, the session and the tokens. */
export interface Entrance {
  url: string;
  session: string | undefined;
  token: string | undefined;
  resume: string | undefined;
}

/** Messages from the page to the worker that owns the connection. */
export type ToWorker =
  | ({ type: 'open' } & Entrance)
  /** Joins another session on the same connection; undefined: the server's first. */
  | { type: 'go'; session: string | undefined }
  | { type: 'request'; key: number; method: MethodName; params: object }
  | { type: 'acknowledge'; number: number }
  /** Returns the memory of an unused frame, by transfer. */
  | { type: 'reuse'; storage: ArrayBuffer }
  | { type: 'watch'; wanted: boolean }
  /** Plays a file, or the file with this address, in place of a session. */
  | { type: 'play'; file: Blob | string; page: string }
  /** Selects whether a recording restarts after its end. */
  | { type: 'loop'; wanted: boolean }
  /** Requests the newest frame in full detail. */
  | { type: 'refresh' }
  /** Selects the attributes in frames and their maximum errors. */
  | { type: 'attributes'; attributes: Attributes };

export type FromWorker =
  | { type: 'state'; state: ConnectionState }
  | { type: 'joined'; joined: JoinedAs }
  | { type: 'description'; description: SessionDescription }
  | { type: 'event'; event: Event }
  | { type: 'frame'; frame: Frame; bytes: number }
  | { type: 'clock'; offset: number }
  /** A recording is open, and its description follows. */
  | { type: 'recorded' }
  /** The recording of `play` cannot be shown. A session continues. */
  | { type: 'unreadable'; message: string }
  | { type: 'resume'; token: string }
  | { type: 'fault'; message: string }
  | { type: 'result'; key: number; result: unknown }
  | { type: 'refusal'; key: number; refusal: Refusal };

/** The fields of a RequestError, because errors lose them between threads. */
export interface Refusal {
  kind: string;
  message: string;
  code: number | undefined;
  data: ErrorData | undefined;
}
