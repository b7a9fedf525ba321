import { Session } from '../../../web/client/index';
import type {
  BodyState,
  Event,
  MethodName,
  Params,
  Result,
  SessionDescription,
  SessionStatus,
  SocketConstructor,
} from '../../../web/client/index';
import { RecordedSocket } from './transcript';

/** A second client in the session that observes the effects of the page's commands. */
export class Observer {
  private readonly session: Session;
  private readonly waiting: ((event: Event) => void)[] = [];
  private entered: (description: SessionDescription) => void = () => undefined;

  private constructor(page: string) {
    const url = new URL('/ws', page);
    url.protocol = 'ws:';
    this.session = new Session(
      {
        url: url.href,
        socket: RecordedSocket as unknown as SocketConstructor,
        now: () => Date.now() / 1000,
      },
      {
        onDescription: (description) => this.entered(description),
        onEvent: (event) => this.waiting.splice(0).forEach((tell) => tell(event)),
        onFrame: ({ header }) => this.session.acknowledge(header.number),
      },
    );
  }

  /** Joins the server's first session. */
  static join(page: string): Promise<Observer> {
    const observer = new Observer(page);
    return new Promise((resolve) => {
      observer.entered = () => resolve(observer);
      observer.session.open();
    });
  }

  leave(): void {
    this.session.close();
  }

  request<M extends MethodName>(method: M, params: Params<M>): Promise<Result<M>> {
    return this.session.request(method, params);
  }

  async tick(): Promise<number> {
    return (await this.session.request('session.hash', {})).tick;
  }

  async body(id: number): Promise<BodyState> {
    const { bodies } = await this.session.request('state.query', { bodies: [id] });
    if (!bodies[0]) throw new Error(`the session has no body ${id}`);
    return bodies[0];
  }

  /** Returns the next periodic status of the session, sent twice per second. */
  async nextStatus(): Promise<SessionStatus> {
    for (;;) {
      const event = await new Promise<Event>((resolve) => this.waiting.push(resolve));
      if (event.event === 'session.status') return event.params;
    }
  }
}
