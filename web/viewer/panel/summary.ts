import { element } from './elements';
import { formatFactor } from './format';

export interface State {
  isConnected: boolean;
  /** Not connected for good: the server has ended it. */
  isEnded: boolean;
  /** There is a picture, be it an old one. */
  hasPicture: boolean;
  playing: boolean;
  speed: number;
  /** The server does not reach the speed that is set. */
  slow: boolean;
  factor: number;
  scene: string;
  people: number;
  role: string | undefined;
  /** A body that is held by the keyboard. */
  held?: string | undefined;
  /** Without a new picture though there should be one [s]. */
  silentSeconds: number;
}

/** Of the speed that is set: what comes that near is not slow. */
const kNearly = 0.95;

/** How long without a picture is worth a word [s]. */
const kSilent = 3;

/** The state in one or two sentences, which change only where it does, so they can be read out. */
export function summarise(state: State): string {
  if (!state.isConnected) return absent(state);
  const parts = [state.playing ? playing(state) : 'Paused'];
  parts.push(state.scene);
  if (state.people > 1) parts.push(`${state.people} people here`);
  if (state.held !== undefined)
    parts.push(`you hold ${state.held}: arrow keys pull it, Esc releases it`);
  if (state.role === 'viewer') parts.push('you watch: ask for control under People');
  const text = `${parts.join(' · ')}.`;
  if (state.playing && state.silentSeconds > kSilent) {
    return `${text} No new frame for some seconds. The server is busy, or the connection is slow.`;
  }
  return text;
}

function absent({ isEnded, hasPicture }: State): string {
  if (!hasPicture) return 'No frame has arrived.';
  const what = 'This is the last frame.';
  return isEnded
    ? `${what} You have left this session. “Come back” joins it again.`
    : `${what} It continues when the server answers.`;
}

function playing({ speed, slow, factor }: State): string {
  const wanted = speed === 1 ? 'in real time' : `at ${formatFactor(speed)}`;
  if (!slow || factor > kNearly * speed) return `Plays ${wanted}`;
  // In steps of a tenth: a text that is read out must not change all the time.
  return `Plays in slow motion, at about ${factor.toFixed(1)} ×. The server cannot compute faster`;
}

/** Whether only the pace is another, which is so all the time where a server is too slow. */
export function onlyPaceDiffers(before: State, state: State): boolean {
  return summarise({ ...before, slow: false }) === summarise({ ...state, slow: false });
}

/** Least time between two words about the pace [ms]. */
const kPeriodMs = 2000;

/** The live text of the page's state. */
export class Summary {
  private readonly text = element('summary', HTMLElement);
  private shown: State | undefined;
  private changedAt = -Infinity;

  show(state: State): void {
    const words = summarise(state);
    if (words === this.text.textContent) return;
    const now = performance.now();
    const isSoon = now - this.changedAt < kPeriodMs;
    if (isSoon && this.shown && onlyPaceDiffers(this.shown, state)) return;
    this.shown = state;
    this.changedAt = now;
    this.text.textContent = words;
  }
}
