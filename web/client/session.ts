import { ClockOffset } from './clock.js';
import { Connection } from './connection.js';
import type { ConnectionOptions, ConnectionState } from './connection.js';
import { FrameDecoder, FrameError, frameNumber } from './frame.js';
import type { Frame } from './frame.js';
import type {
  Attributes,
  Event,
  JoinedAs,
  MethodName,
  Params,
  Result,
  SessionDescription,
} from './messages.js';
import { RequestError } from './requests.js';

export interface SessionHandlers {
  onState?(state: ConnectionState): void;
  /** Who we are in the session and who else is there; before its description. */
  onJoined?(joined: JoinedAs): void;
  /** After joining, and after each change of scene or bodies before its first frame. */
  onDescription?(description: SessionDescription): void;
  onEvent?(event: Event): void;
  /** A decoded frame and its size. Answer with `acknowledge` once it is taken. */
  onFrame?(frame: Frame, bytes: number): void;
  /** What the next frame is decoded to: one that is not in use any more. By default a new one. */
  frameFor?(): Frame;
  /** The secret by which this participant may come back, on this line or another. */
  onResumeToken?(token: string): void;
  /** Seconds that the server's clock is ahead of `now`. */
  onClockOffset?(seconds: number): void;
  /** Something that a user should hear of; the session goes on. */
  onFault?(message: string): void;
}

export interface SessionOptions extends ConnectionOptions {
  /** The session to join; by default the server's first. */
  session?: string | undefined;
  /** What lets us in where the server asks for it: of an invitation, a ticket or an admin. */
  token?: string | undefined;
  /** Who we were: `onResumeToken` told it. */
  resume?: string | undefined;
  /** Our clock [s]. */
  now: () => number;
  /** Time between two round trips that measure the clock and prove that the line lives. */
  clockPeriodMs?: number;
  /**
   * The greatest error of a position over the radius of the scene's smallest particles; by default
   * what the session gives.
   */
  errorInRadii?: number;
}

const kSilent = 'the server does not answer; it is busy, or the connection is slow';

/** One client in a session: joins, subscribes, and does so again after a break. */
export class Session {
  private readonly connection: Connection;
  private clock = new ClockOffset();
  private decoder = new FrameDecoder();
  private clockTimer: ReturnType<typeof setTimeout> | undefined;
  private isLetIn = false;
  private hasJoined = false;
  private isWatched = true;
  /** The session to be in; undefined: the server's first. */
  private wanted: string | undefined;
  private resume: string | undefined;
  /** What was subscribed to, or is to be [m]; undefined: what the session gives. */
  private maxError: number | undefined;
  private attributes: Attributes = {};

  constructor(
    private readonly options: SessionOptions,
    private readonly handlers: SessionHandlers,
  ) {
    this.resume = options.resume;
    this.wanted = options.session;
    this.connection = new Connection(options, {
      onState: (state) => this.handleState(state),
      onEvent: (event) => this.handleEvent(event),
      onFrame: (bytes) => this.handleFrame(bytes),
      onFault: (message) => handlers.onFault?.(message),
    });
  }

  open(): void {
    this.connection.open();
  }

  close(): void {
    this.connection.close();
  }

  /** Takes part in another session, by the same line; undefined: in the server's first. */
  go(session: string | undefined): void {
    this.wanted = session;
    this.resume = undefined;
    if (this.isLetIn) this.join().catch((error: unknown) => this.restart(error));
  }

  request<M extends MethodName>(method: M, params: Params<M>): Promise<Result<M>> {
    return this.connection.request(method, params);
  }

  /** Acknowledges the frame with this number and all before it; the server then sends more. */
  acknowledge(number: number): void {
    this.connection.notify('frames.ack', { number });
  }

  /**
   * Whether frames are wanted. A client that draws nothing for long has to say so: the server closes
   * one that acknowledges nothing.
   */
  watch(wanted: boolean): void {
    if (wanted === this.isWatched) return;
    this.isWatched = wanted;
    if (!this.hasJoined) return;
    const request = wanted ? this.subscribe() : this.request('frames.unsubscribe', {});
    request.catch((error: unknown) => this.restart(error));
  }

  /** Which values of particles frames are to have, and how exactly; none from the start. */
  askFor(attributes: Attributes): void {
    if (JSON.stringify(attributes) === JSON.stringify(this.attributes)) return;
    this.attributes = { ...attributes };
    this.subscribeAgain();
  }

  /** The newest frame once more, whole: the server forgets that we were too slow for such ones. */
  refresh(): void {
    this.subscribeAgain();
  }

  private async subscribe(): Promise<void> {
    await this.request('frames.subscribe', {
      ...(this.maxError !== undefined && { max_error: this.maxError }),
      ...(Object.keys(this.attributes).length > 0 && { attributes: this.attributes }),
    });
  }

  private subscribeAgain(): void {
    if (!this.hasJoined || !this.isWatched) return;
    this.subscribe().catch((error: unknown) => this.restart(error));
  }

  private describe(description: SessionDescription): void {
    this.handlers.onDescription?.(description);
    const { errorInRadii } = this.options;
    const radius = Math.min(...description.bodies.map((body) => body.radius));
    const isKnown = errorInRadii !== undefined && Number.isFinite(radius) && radius > 0;
    const before = this.maxError;
    this.maxError = isKnown ? errorInRadii * radius : undefined;
    if (this.maxError !== before) this.subscribeAgain();
  }

  private handleState(state: ConnectionState): void {
    clearTimeout(this.clockTimer);
    this.isLetIn = this.hasJoined = false;
    this.handlers.onState?.(state);
    if (state.name === 'open') void this.enter();
  }

  private async enter(): Promise<void> {
    this.hasJoined = false;
    try {
      this.clock = new ClockOffset();
      const { access } = await this.measureClock();
      await this.letIn(access);
      this.isLetIn = true;
      await this.join();
    } catch (error) {
      this.restart(error);
    }
  }

  private async join(): Promise<void> {
    this.hasJoined = false;
    const { wanted, resume } = this;
    this.decoder = new FrameDecoder();
    const joined = await this.request('session.join', {
      ...(wanted !== undefined && { session: wanted }),
      ...(resume !== undefined && { resume }),
    });
    if (wanted !== this.wanted) return; // gone on elsewhere
    this.resume = joined.resume;
    this.handlers.onResumeToken?.(joined.resume);
    this.handlers.onJoined?.(joined);
    this.describe(joined.description);
    this.hasJoined = true;
    if (this.isWatched) await this.subscribe();
  }

  /** Shows who we were, or what we were given, where that is asked for or changes our role. */
  private async letIn(access: Result<'server.info'>['access']): Promise<void> {
    const { token } = this.options;
    if (access === 'token' && this.resume !== undefined && (await this.isGood(this.resume))) return;
    if (token !== undefined && (await this.isGood(token))) return;
    if (access !== 'token') return;
    const words = 'this server needs an invitation; open your invitation link, or ask for one';
    throw new RequestError('not_authenticated', words);
  }

  private async isGood(token: string): Promise<boolean> {
    try {
      await this.request('access.enter', { token });
      return true;
    } catch (error) {
      if (error instanceof RequestError && error.kind === 'not_authenticated') return false;
      throw error;
    }
  }

  /** A request that entering or measuring needs has failed: begin again on a new line. */
  private restart(error: unknown): void {
    if (!(error instanceof RequestError)) throw error;
    // Who uses the page knows no methods. Does nothing if the line is down already.
    this.connection.restart(error.kind === 'timed_out' ? kSilent : error.message);
  }

  private async measureClock(): Promise<Result<'server.info'>> {
    const sent = this.options.now();
    const info = await this.request('server.info', {});
    this.clock.add(sent, this.options.now(), info.time);
    if (this.clock.seconds !== undefined) this.handlers.onClockOffset?.(this.clock.seconds);
    clearTimeout(this.clockTimer);
    this.clockTimer = setTimeout(
      () => void this.measureClock().catch((error: unknown) => this.restart(error)),
      this.options.clockPeriodMs ?? 5000,
    );
    return info;
  }

  private handleEvent(event: Event): void {
    if (event.event === 'session.description') this.describe(event.params);
    else this.handlers.onEvent?.(event);
    if (event.event === 'session.closed') void this.enter(); // the server may have another one
  }

  private handleFrame(bytes: ArrayBuffer): void {
    const wasWaiting = this.decoder.needsKey;
    let frame: Frame;
    try {
      frame = this.decoder.decode(bytes, this.handlers.frameFor?.());
    } catch (error) {
      if (!(error instanceof FrameError)) throw error;
      this.refuse(bytes, error, wasWaiting);
      return;
    }
    this.handlers.onFrame?.(frame, bytes.byteLength);
  }

  /** Frames to come may build on what is refused: a new subscription begins with a key frame. */
  private refuse(bytes: ArrayBuffer, error: FrameError, wasWaiting: boolean): void {
    const number = frameNumber(bytes);
    if (number !== undefined) this.acknowledge(number); // or it would wait for that
    if (wasWaiting && error.code === 'missing_reference') return; // the key frame is on its way
    const words = `an invalid frame (${error.code}): ${error.message}`;
    this.handlers.onFault?.(words);
    if (wasWaiting) this.connection.restart(words);
    else this.subscribeAgain();
  }
}
