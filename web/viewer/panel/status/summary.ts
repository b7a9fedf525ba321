import { element } from '../elements';
import { formatError, formatFactor } from '../format';

export interface State {
  isConnected: boolean;
  /** Whether the server has closed the connection permanently. */
  isEnded: boolean;
  /** Whether there is a picture, even an old one. */
  hasPicture: boolean;
  playing: boolean;
  speed: number;
  /** Whether the server does not reach the set speed. */
  slow: boolean;
  factor: number;
  /** The relative error, if the server has reduced the accuracy. */
  reducedError?: number | undefined;
  scene: string;
  people: number;
  role: string | undefined;
  /** The body that the keyboard holds. */
  held?: string | undefined;
  /** The time without an expected picture [s]. */
  silentSeconds: number;
}

/** A larger share of the set speed is not slow. */
const kNearly = 0.95;

/** A longer time without a picture is reported [s]. */
const kSilent = 3;

/** Returns the state in one or two sentences, for screen readers. They change only with the state. */
export function summarise(state: State): string {
  if (!state.isConnected) return absent(state);
  const parts = [state.playing ? playing(state) : 'Paused'];
  if (state.reducedError !== undefined)
    parts.push(`Accuracy reduced: error ${formatError(state.reducedError)}`);
  parts.push(state.scene);
  if (state.people > 1) parts.push(`${state.people} people here`);
  if (state.held !== undefined)
    parts.push(`you hold ${state.held}: arrow keys pull or aim, Enter releases it`);
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
    : `${what} The display continues when the server answers.`;
}

function playing({ speed, slow, factor }: State): string {
  const wanted = speed === 1 ? 'in real time' : `at ${formatFactor(speed)}`;
  if (!slow || factor > kNearly * speed) return `Plays ${wanted}`;
  // In steps of 0.1, because a text for screen readers must not change continually.
  return `Plays in slow motion, at about ${factor.toFixed(1)} ×. The server cannot compute faster`;
}

/** Returns whether only the speed differs, which changes continually on a slow server. */
export function onlyPaceDiffers(before: State, state: State): boolean {
  return summarise({ ...before, slow: false }) === summarise({ ...state, slow: false });
}

/** The minimum interval of texts about the speed [ms]. */
const kPeriodMs = 2000;

/** The live text of the page's state, for screen readers. */
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
