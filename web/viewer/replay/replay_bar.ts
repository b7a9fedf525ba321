import type { Event, SessionDescription, SessionStatus } from '../../client/index';
import { element, make, makeButton } from '../panel/elements';
import { formatSeconds } from '../panel/format';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import { Newest } from '../stream/newest';
import { kRecordedSession } from '../stream/recording_file';
import type { Stage } from '../view/stage';
import { RecordedCompany } from './recorded_people';
import { Timeline } from './timeline';
import './replay.css';

export interface ReplayActions {
  togglePlaying(): void;
  /** Returns to the live session. A page without sessions has no button for it. */
  leave?(): void;
  /** Selects whether a recording of frames restarts after its end. */
  loop(wanted: boolean): void;
  nameOfBody(body: number): string;
}

interface Divergence {
  position: number;
  reason: string;
}

/** The bar over the picture of a replay: position, participants, return. */
export class ReplayBar {
  private readonly bar = element('replay', HTMLElement);
  private readonly title = make('b');
  private readonly play: HTMLButtonElement;
  private readonly words = make('p', { id: 'replay-words' });
  private readonly timeline: Timeline;
  private readonly company: RecordedCompany;
  private readonly loop: HTMLLabelElement;
  private replay: SessionDescription['replay'];
  private tickSeconds = 0;
  private status: SessionStatus | undefined;
  private position: number | undefined;

  constructor(
    private readonly desk: Desk,
    stage: Stage,
    actions: ReplayActions,
  ) {
    const seeks = new Newest((position: number) => ask(desk, 'replay.seek', { position }));
    this.timeline = new Timeline((position) => seeks.put(position));
    this.company = new RecordedCompany(stage, (body) => actions.nameOfBody(body));
    this.play = makeButton('Play', () => actions.togglePlaying());
    this.play.id = 'replay-play';
    const back = makeButton('Back to live', () => actions.leave?.());
    back.id = 'replay-leave';
    back.hidden = !actions.leave;
    this.words.role = 'status';
    const head = make('header', {}, this.title, back);
    const box = make('input', { type: 'checkbox', id: 'replay-loop', checked: true });
    box.addEventListener('change', () => actions.loop(box.checked));
    this.loop = make('label', { hidden: true }, box, ' Loop');
    const row = make('div', { className: 'row' }, this.play, this.timeline.element, this.loop);
    this.bar.append(head, row, this.words, this.company.list);
  }

  /** Shows the bar if the session is a replay. */
  describe({ replay, tick_seconds: tickSeconds, name, session }: SessionDescription): void {
    this.loop.hidden = session !== kRecordedSession;
    const isNew = replay && (!this.replay || this.bar.hidden);
    this.replay = replay;
    this.tickSeconds = tickSeconds;
    this.bar.hidden = !replay;
    if (!replay) {
      this.company.show([]);
      return;
    }
    this.title.textContent = `Recording of “${name}”`;
    this.timeline.describe({ ...replay, tickSeconds });
    this.showPosition(replay.position);
    this.showDivergence(undefined);
    if (isNew) this.words.textContent = '';
    void this.refresh();
  }

  handle({ event, params }: Event): void {
    if (event === 'session.status') this.showStatus(params);
    else if (!this.replay) return;
    else if (event === 'replay.people') this.company.show(params.people);
    else if (event === 'replay.diverged') this.showDivergence(params);
    else if (event === 'replay.ended') this.words.textContent = 'The recording has ended.';
  }

  /** The shown position; undefined if the session is not a replay. */
  get moment(): number | undefined {
    return this.replay && this.position;
  }

  /** Displays the tick of the current frame. */
  showTick(tick: number): void {
    const { replay, status } = this;
    if (!replay || status?.position === undefined || tick < status.tick) return;
    this.showPosition(Math.min(status.position + tick - status.tick, replay.end));
  }

  private showPosition(position: number): void {
    this.position = position;
    this.timeline.show(position);
  }

  /** Moves the names to their present positions in the picture. */
  update(): void {
    if (this.replay) this.company.update();
  }

  private showStatus(status: SessionStatus): void {
    this.status = status;
    if (!this.replay || status.position === undefined) return;
    this.showPosition(status.position);
    this.play.textContent = status.playing ? 'Pause' : 'Play';
    if (status.position < this.replay.end && this.words.dataset.diverged !== 'true') {
      this.words.textContent = '';
    }
  }

  /** Requests the state of a replay, after joining and after a seek. */
  private async refresh(): Promise<void> {
    const info = await ask(this.desk, 'replay.info', {});
    if (!info || !this.replay) return;
    this.title.textContent = `Recording of “${info.name}”`;
    this.company.show(info.people);
    this.showDivergence(info.diverged ?? undefined);
  }

  private showDivergence(divergence: Divergence | undefined): void {
    const { replay, words, tickSeconds } = this;
    if (!replay) return;
    words.dataset.diverged = String(divergence !== undefined);
    this.timeline.showDivergence(divergence?.position);
    if (!divergence) return;
    const at = formatSeconds((divergence.position - replay.begin) * tickSeconds);
    words.textContent = `At ${at}, the replay differs from the recording: ${divergence.reason}. It is paused there. The Play button continues from the computed state. Use the time line to go to another position.`;
  }
}
