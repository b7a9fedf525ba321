import type { SessionDescription, SessionStatus } from '../client/index';
import { make, makeButton } from '../viewer/panel/elements';
import { Timeline } from '../viewer/replay/timeline';
import { Newest } from '../viewer/stream/newest';
import type { Request } from '../viewer/stream/stream';

/** The controls below the picture: play and pause, reset of live sessions, time line of recordings. */
export class Controls {
  readonly element = make('div', { className: 'controls' });
  private readonly play = makeButton('Play', () => this.toggle());
  private readonly reset = makeButton('Reset', () => this.ask('control.reset'));
  private readonly timeline: Timeline;
  private playing = false;

  /** `refuse` receives rejected requests. */
  constructor(
    private readonly request: Request,
    private readonly refuse: (error: unknown) => void,
  ) {
    const seeks = new Newest((position: number) =>
      request('replay.seek', { position }).catch(refuse),
    );
    this.timeline = new Timeline((position) => seeks.put(position));
    this.element.append(this.play, this.reset, this.timeline.element);
  }

  describe({ replay, playing, tick_seconds: tickSeconds }: SessionDescription): void {
    this.reset.hidden = replay !== undefined;
    this.timeline.element.hidden = replay === undefined;
    if (replay) {
      this.timeline.describe({ ...replay, tickSeconds });
      this.timeline.show(replay.position);
    }
    this.showPlaying(playing);
  }

  showStatus({ playing, position }: SessionStatus): void {
    this.showPlaying(playing);
    if (position !== undefined) this.timeline.show(position);
  }

  private showPlaying(playing: boolean): void {
    this.playing = playing;
    this.play.textContent = playing ? 'Pause' : 'Play';
  }

  private toggle(): void {
    this.ask(this.playing ? 'control.pause' : 'control.play');
  }

  private ask(method: 'control.play' | 'control.pause' | 'control.reset'): void {
    this.request(method, {}).catch(this.refuse);
  }
}
