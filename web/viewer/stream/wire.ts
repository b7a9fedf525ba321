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

/** Where to enter, and what lets us in. */
export interface Entrance {
  url: string;
  session: string | undefined;
  token: string | undefined;
  resume: string | undefined;
}

/** Messages between the page and the worker that holds the connection. */
export type ToWorker =
  | ({ type: 'open' } & Entrance)
  /** To another session, by the same line; undefined: the server's first. */
  | { type: 'go'; session: string | undefined }
  | { type: 'request'; key: number; method: MethodName; params: object }
  | { type: 'acknowledge'; number: number }
  /** Of a frame that is shown no more; it is transferred, like that of each frame. */
  | { type: 'reuse'; storage: ArrayBuffer }
  | { type: 'watch'; wanted: boolean }
  /** The newest frame once more, whole. */
  | { type: 'refresh' }
  /** The values of particles that frames are to have, and how exactly. */
  | { type: 'attributes'; attributes: Attributes };

export type FromWorker =
  | { type: 'state'; state: ConnectionState }
  | { type: 'joined'; joined: JoinedAs }
  | { type: 'description'; description: SessionDescription }
  | { type: 'event'; event: Event }
  | { type: 'frame'; frame: Frame; bytes: number }
  | { type: 'clock'; offset: number }
  | { type: 'resume'; token: string }
  | { type: 'fault'; message: string }
  | { type: 'result'; key: number; result: unknown }
  | { type: 'refusal'; key: number; refusal: Refusal };

/** A RequestError's fields: errors lose theirs between threads. */
export interface Refusal {
  kind: string;
  message: string;
  code: number | undefined;
  data: ErrorData | undefined;
}
