import type { ConnectionState, FrameHeader } from '../../client/index';
import { element, onPress } from './elements';
import { showObstacle } from './obstacle';
import { lossInWords } from './quality';

const kConnected = 'Connected';

/** A first picture that comes within this time needs no words before [ms]. */
const kSoonMs = 1500;

/** The connection's state in words, and a button with a count-down to the next attempt. */
export class ConnectionLine {
  private readonly line = element('connection', HTMLElement);
  private readonly text = element('connection-text', HTMLElement);
  private readonly retry = element('connection-retry', HTMLButtonElement);
  private readonly first = element('connection-first', HTMLButtonElement);
  private countdown: number | undefined;
  private hasPicture = false;
  private absence: number | undefined;

  /** `goToFirst`: to the server's first session; `isNamed`: whether the page's address has another. */
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
    // An open line is worth nothing before the session has answered.
    this.line.dataset.state = state.name === 'open' ? 'connecting' : state.name;
    this.retry.hidden = state.name !== 'waiting' && !isEnded(state);
    this.first.hidden = state.name !== 'waiting' || !this.isNamed();
    this.text.textContent = words(state);
    if (state.name === 'waiting') this.countDown(state.retryMs);
    else this.retry.textContent = 'Come back';
    this.explainAbsence(state);
  }

  /** The session has answered. */
  join(): void {
    this.line.dataset.state = 'open';
    this.text.textContent = kConnected;
  }

  /** Says where this viewer does not get all frames: the line, or what draws here, is too slow. */
  showFrame(header: FrameHeader): void {
    this.hasPicture = true;
    window.clearTimeout(this.absence);
    showObstacle('server', undefined);
    const loss = lossInWords(header);
    const text = loss === undefined ? kConnected : `Slow: ${loss}`;
    this.line.dataset.slow = String(loss !== undefined);
    if (this.text.textContent !== text) this.text.textContent = text;
  }

  /** Where there is no picture at all, not even an old one, the middle of the page says why. */
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

  /** On the button: a text that is read out must not change every second. */
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

/** For good, by the server. */
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
