import { RequestError } from '../../client/index';
import type { MethodName, Params, Result } from '../../client/index';
import { describeFault } from '../panel/errors';
import type { Request } from './stream';

/** What the parts of the page that ask the server for something need. */
export interface Desk {
  readonly request: Request;
  /** Tells the user what the server refused. */
  refuse(error: unknown): void;
  /** Tells the user what cannot be done, and why. */
  fail(words: string): void;
  /** Tells the user something for a while. */
  say(words: string): void;
}

/**
 * What the server has against it, in words for who asked; undefined where it was done, or where the
 * line is down, which is seen elsewhere.
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

/** The answer; undefined where it was refused, which the user is told. */
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
