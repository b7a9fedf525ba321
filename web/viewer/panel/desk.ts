import { RequestError } from '../../client/index';
import type { MethodName, Params, Result } from '../../client/index';
import { describeFault } from './errors';
import type { Request } from '../stream/stream';

/** Requests to the server, and messages to the user, for all parts of the page. */
export interface Desk {
  readonly request: Request;
  /** Reports a rejected request to the user. */
  refuse(error: unknown): void;
  /** Reports a failure and its reason to the user. */
  fail(words: string): void;
  /** Shows a temporary message. */
  say(words: string): void;
}

/**
 * Sends a request. Returns the error as text; undefined after success or without a connection, which
 * the page reports elsewhere.
 */
export async function attempt<M extends MethodName>(
  desk: Desk,
  method: M,
  params: Params<M>,
): Promise<string | undefined> {
  try {
    await desk.request(method, params);
    return undefined;
  } catch (error) {
    if (!(error instanceof RequestError)) throw error;
    if (error.kind === 'disconnected') return undefined;
    return describeFault(error);
  }
}

/** Sends a request and returns its result. Reports errors to the user and returns undefined. */
export async function ask<M extends MethodName>(
  desk: Desk,
  method: M,
  params: Params<M>,
): Promise<Result<M> | undefined> {
  try {
    return await desk.request(method, params);
  } catch (error) {
    desk.refuse(error);
    return undefined;
  }
}
