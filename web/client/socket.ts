/** The members of a WebSocket that the client uses; common to browsers and the `ws` package. */
export interface Socket {
  binaryType: string;
  onopen: ((event: never) => void) | null;
  onclose: ((event: never) => void) | null;
  onmessage: ((event: never) => void) | null;
  onerror: ((event: never) => void) | null;
  send(text: string): void;
  close(code?: number, reason?: string): void;
}

export type SocketConstructor = new (url: string, protocol: string) => Socket;

export interface SocketClose {
  code: number;
  reason: string;
}

/** Texts for the close codes of PROTOCOL.md and of a lost connection. */
const kCloseReasons: Readonly<Record<number, string>> = {
  1001: 'the server stops',
  1002: 'the server received an invalid message',
  1006: 'the server cannot be reached',
  1009: 'a message was too large',
  1013: 'the server has too many connections',
  4001: 'no valid token was sent in time',
  4003: 'removed from the session',
  4008: 'this client is too slow',
  4009: 'this client sends too much',
  4010: 'this participant continues in another window',
  4012: 'the session moves to another server',
};

/** Codes after which the client does not reconnect. */
const kFinalCodes: ReadonlySet<number> = new Set([4003, 4010]);

export function isFinal({ code }: SocketClose): boolean {
  return kFinalCodes.has(code);
}

export function describeClose({ code, reason }: SocketClose): string {
  const words = kCloseReasons[code] ?? `close code ${code}`;
  return reason === '' ? words : `${words}: ${reason}`;
}
