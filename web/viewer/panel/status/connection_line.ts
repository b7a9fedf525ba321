import type { ConnectionState, FrameHeader } from '../../../client/index';
import { element, onPress } from '../elements';
import { showObstacle } from '../obstacle';
import { lossInWords } from './quality';

const kConnected = 'Connected';
const kRecorded = 'Recording';

/** No text is shown if the first picture arrives within this time [ms]. */
const kSoonMs = 1500;

/** The connection's state as text, and a button with a count-down to the next attempt. */
export class ConnectionLine {
  private readonly line = element('connection', HTMLElement);
  private readonly text = element('connection-text', HTMLElement);
  private readonly retry = element('connection-retry', HTMLButtonElement);
  private readonly first = element('connection-first', HTMLButtonElement);
  private countdown: number | undefined;
  private hasPicture = false;
  /** The text while frames arrive. */
  private connected = kConnected;
  private absence: number | undefined;

  /** `goToFirst` switches to the first session. `isNamed`: whether the page's address names one. */
  constructor(
    retryNow: () => void,
    goToFirst: () => void,
    private readonly isNamed: () => boolean,
  ) {
    onPress(this.retry, retryNow);
    onPress(this.first, goToFirst);
  }

  show(state: ConnectionState): void {
    window.clearInterval(this.countdown);
    // The state remains "connecting" until the session replies.
    this.line.dataset.state = state.name === 'open' ? 'connecting' : state.name;
    this.retry.hidden = state.name !== 'waiting' && !isEnded(state);
    this.first.hidden = state.name !== 'waiting' || !this.isNamed();
    this.text.textContent = words(state);
    if (state.name === 'waiting') this.countDown(state.retryMs);
    else this.retry.textContent = 'Come back';
    this.explainAbsence(state);
  }

  /** Called after the session's reply. */
  join(): void {
    this.showConnected(kConnected);
  }

  /** Called when a recording plays in place of a session. */
  showRecorded(): void {
    window.clearInterval(this.countdown);
    window.clearTimeout(this.absence);
    this.retry.hidden = this.first.hidden = true;
    this.showConnected(kRecorded);
  }

  /** Shows whether this viewer receives fewer frames because its connection or graphics are slow. */
  showFrame(header: FrameHeader): void {
    this.hasPicture = true;
    window.clearTimeout(this.absence);
    showObstacle('server', undefined);
    const loss = lossInWords(header);
    const text = loss === undefined ? this.connected : `Slow: ${loss}`;
    this.line.dataset.slow = String(loss !== undefined);
    if (this.text.textContent !== text) this.text.textContent = text;
  }

  private showConnected(words: string): void {
    this.connected = words;
    this.line.dataset.state = 'open';
    this.text.textContent = words;
  }

  /** Shows the reason in the middle of the page if there has been no picture yet. */
  private explainAbsence(state: ConnectionState): void {
    if (this.hasPicture) return;
    window.clearTimeout(this.absence);
    if (state.name === 'waiting') {
      showObstacle('server', `${words(state)}. The page reconnects automatically.`);
    } else if (isEnded(state)) {
      showObstacle('server', `${words(state)}.`);
    } else {
      const say = (): void => showObstacle('server', 'Waiting for the first frame …');
      this.absence = window.setTimeout(say, kSoonMs);
    }
  }

  /** Counts down on the button, because a text for screen readers must not change every second. */
  private countDown(retryMs: number): void {
    const end = performance.now() + retryMs;
    const show = (): void => {
      const seconds = Math.max(1, Math.ceil((end - performance.now()) / 1000));
      this.retry.textContent = `Try now (${seconds} s)`;
    };
    show();
    this.countdown = window.setInterval(show, 250);
  }
}

/** Returns whether the server has closed the connection permanently. */
function isEnded(state: ConnectionState): boolean {
  return state.name === 'closed' && state.reason !== undefined;
}

function words(state: ConnectionState): string {
  switch (state.name) {
    case 'connecting':
      return 'Connecting …';
    case 'open':
      return 'Waiting for the session …';
    case 'waiting':
      return `Not connected: ${state.reason}`;
    case 'closed':
      return state.reason === undefined ? 'Not connected' : `Not connected: ${state.reason}`;
  }
}
