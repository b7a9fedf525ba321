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
  /** Called after joining, before the description: this participant and the others. */
  onJoined?(joined: JoinedAs): void;
  /** Called after joining and after each change of scene or bodies, before the next frame. */
  onDescription?(description: SessionDescription): void;
  onEvent?(event: Event): void;
  /** Receives a decoded frame and its size. Call `acknowledge` after processing it. */
  onFrame?(frame: Frame, bytes: number): void;
  /** Returns an unused frame for the next decoding. By default, frames are newly allocated. */
  frameFor?(): Frame;
  /** Receives the token with which this participant can resume on any connection. */
  onResumeToken?(token: string): void;
  /** Receives the server's time minus `now` [s]. */
  onClockOffset?(seconds: number): void;
  /** Receives a message for the user. The session continues. */
  onFault?(message: string): void;
}

export interface SessionOptions extends ConnectionOptions {
  /** The session to join; by default the server's first. */
  session?: string | undefined;
  /** The token of an invitation, a ticket or an admin, if the server requires one. */
  token?: string | undefined;
  /** The token of `onResumeToken`, to resume a participant. */
  resume?: string | undefined;
  /** Returns the local time [s]. */
  now: () => number;
  /** The period of round trips, which measure the clock and check the connection. */
  clockPeriodMs?: number;
  /**
   * The maximum position error divided by the radius of the smallest particles; by default the
   * session's value.
   */
  errorInRadii?: number;
  /**
   * The greatest number of particles of liquid and deformable bodies in a frame: frames of larger
   * scenes have a lower level of detail. By default, frames have all particles.
   */
  mostParticles?: number;
}

/** The greatest level of detail. Each lower level halves the particles. */
const kFullDetail = 3;

/** Returns the greatest level of detail with at most this number of particles, or 0. */
function detailFor({ bodies }: SessionDescription, mostParticles: number): number {
  let count = 0;
  for (const { kind, particles } of bodies) if (kind !== 'rigid') count += particles;
  let detail = kFullDetail;
  while (detail > 0 && count / 2 ** (kFullDetail - detail) > mostParticles) detail -= 1;
  return detail;
}

const kSilent = 'the server does not answer; it is busy, or the connection is slow';

/** A client of a session. It joins and subscribes, also after reconnecting. */
export class Session {
  private readonly connection: Connection;
  private clock = new ClockOffset();
  private decoder = new FrameDecoder();
  private clockTimer: ReturnType<typeof setTimeout> | undefined;
  private isLetIn = false;
  private hasJoined = false;
  private isWatched = true;
  /** The session to join; undefined: the server's first. */
  private wanted: string | undefined;
  private resume: string | undefined;
  /** The maximum position error of the subscription [m]; undefined: the session's value. */
  private maxError: number | undefined;
  private detail = kFullDetail;
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

  /** Joins another session on the same connection; undefined: the server's first. */
  go(session: string | undefined): void {
    this.wanted = session;
    this.resume = undefined;
    if (this.isLetIn) this.join().catch((error: unknown) => this.restart(error));
  }

  request<M extends MethodName>(method: M, params: Params<M>): Promise<Result<M>> {
    return this.connection.request(method, params);
  }

  /** Acknowledges all frames up to this number. The server then sends further frames. */
  acknowledge(number: number): void {
    this.connection.notify('frames.ack', { number });
  }

  /**
   * Subscribes or unsubscribes. A client that stops drawing must unsubscribe, because the server
   * closes connections that do not acknowledge frames.
   */
  watch(wanted: boolean): void {
    if (wanted === this.isWatched) return;
    this.isWatched = wanted;
    if (!this.hasJoined) return;
    const request = wanted ? this.subscribe() : this.request('frames.unsubscribe', {});
    request.catch((error: unknown) => this.restart(error));
  }

  /** Selects the attributes in frames and their maximum errors; initially none. */
  askFor(attributes: Attributes): void {
    if (JSON.stringify(attributes) === JSON.stringify(this.attributes)) return;
    this.attributes = { ...attributes };
    this.subscribeAgain();
  }

  /** Requests the newest frame in the greatest detail of the options, and resets the server's reduction for slow clients. */
  refresh(): void {
    this.subscribeAgain();
  }

  private async subscribe(): Promise<void> {
    await this.request('frames.subscribe', {
      ...(this.maxError !== undefined && { max_error: this.maxError }),
      ...(this.detail < kFullDetail && { detail: this.detail }),
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
    const { maxError, detail } = this;
    this.maxError = isKnown ? errorInRadii * radius : undefined;
    this.detail = detailFor(description, this.options.mostParticles ?? Infinity);
    if (this.maxError !== maxError || this.detail !== detail) this.subscribeAgain();
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
    if (wanted !== this.wanted) return; // another session was chosen
    this.resume = joined.resume;
    this.handlers.onResumeToken?.(joined.resume);
    this.handlers.onJoined?.(joined);
    this.describe(joined.description);
    this.hasJoined = true;
    if (this.isWatched) await this.subscribe();
  }

  /** Presents the token if the server requires it or if it changes the role. */
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

  /** Reconnects after the failure of a request that joining or measuring requires. */
  private restart(error: unknown): void {
    if (!(error instanceof RequestError)) throw error;
    if (error.kind === 'moved') {
      this.connection.redirect(error.data?.url ?? '');
      return;
    }
    // The text for users omits the method. Without a connection, restart() does nothing.
    this.connection.restart(error.kind === 'timed_out' ? kSilent : error.message);
  }

  private async measureClock(): Promise<Result<'server.info'>> {
    const sent = this.options.now();
    const info = await this.request('server.info', {});
    this.connection.useNodes(info.nodes ?? []);
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
    if (event.event === 'session.closed') void this.enter(); // the server can have another session
    if (event.event === 'session.moved') this.connection.redirect(event.params.url);
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

  /**
   * Reports an invalid frame, and the server sends a key frame. Until then, later frames that refer
   * to it are rejected too, and only acknowledged.
   */
  private refuse(bytes: ArrayBuffer, error: FrameError, wasWaiting: boolean): void {
    const number = frameNumber(bytes);
    const isExpected = wasWaiting && error.code === 'missing_reference';
    if (number !== undefined) this.reject(number, !isExpected);
    if (isExpected) return;
    const words = `an invalid frame (${error.code}): ${error.message}`;
    this.handlers.onFault?.(words);
    if (wasWaiting) this.connection.restart(words);
    else if (number === undefined) this.subscribeAgain(); // there is no number to reject
  }

  private reject(number: number, needsKey: boolean): void {
    this.connection.notify('frames.ack', { number, ...(needsKey && { rejected: true }) });
  }
}
