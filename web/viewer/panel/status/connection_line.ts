import type { ConnectionState, FrameHeader } from '../../../client/index';
import { element, onPress } from '../elements';
import { showObstacle } from '../obstacle';
import { lossInWords } from './quality';

const kRecorded = 'Recording';

/** The time of the notice that the session moves to another server [ms]. */
const kMoveMs = 1000;

/** No text is shown if the first picture arrives within this time [ms]. */
const kSoonMs = 1500;

/** The connection's state as text, and a button with a count-down to the next attempt. */
export class ConnectionLine {
  private readonly line = element('connection', HTMLElement);
  private readonly text = element('connection-text', HTMLElement);
  private readonly node = element('connection-node', HTMLElement);
  private readonly retry = element('connection-retry', HTMLButtonElement);
  private readonly first = element('connection-first', HTMLButtonElement);
  private countdown: number | undefined;
  private hasPicture = false;
  private isRecorded = false;
  /** The state of the connection; undefined: the session has replied. */
  private state: ConnectionState | undefined;
  private moving: number | undefined;
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
    this.state = state;
    this.isRecorded = false;
    this.write();
    if (state.name === 'waiting') this.countDown(state.retryMs);
    else this.retry.textContent = 'Come back';
    this.explainAbsence(state);
  }

  /** Called after the session's reply. */
  join(): void {
    this.showConnected();
  }

  /** Shows the server's name in its cluster; undefined: there is no cluster. */
  showNode(node: string | undefined): void {
    this.node.hidden = node === undefined;
    this.node.textContent = node === undefined ? '' : `on ${node}`;
  }

  /** Called if another server continues the session. Shows this for a short time. */
  showMove(): void {
    window.clearTimeout(this.moving);
    this.moving = window.setTimeout(() => {
      this.moving = undefined;
      this.write();
    }, kMoveMs);
    this.write();
  }

  /** Called when a recording plays in place of a session. */
  showRecorded(): void {
    window.clearInterval(this.countdown);
    window.clearTimeout(this.absence);
    this.retry.hidden = this.first.hidden = true;
    this.isRecorded = true;
    this.showConnected();
  }

  /** Shows whether this viewer receives fewer frames because its connection or graphics are slow. */
  showFrame(header: FrameHeader): void {
    this.hasPicture = true;
    window.clearTimeout(this.absence);
    showObstacle('server', undefined);
    const loss = lossInWords(header);
    this.line.dataset.slow = String(loss !== undefined);
    this.write(loss);
  }

  private showConnected(): void {
    this.state = undefined;
    this.line.dataset.state = 'open';
    this.write();
  }

  /** Writes the state. `loss`: the frames and particles that this viewer does not receive. */
  private write(loss?: string): void {
    const isMoving = this.moving !== undefined;
    const text =
      this.state === undefined
        ? this.connected(isMoving, loss)
        : isMoving && isBetween(this.state)
          ? 'The session moves …'
          : words(this.state);
    if (this.text.textContent !== text) this.text.textContent = text;
  }

  private connected(isMoving: boolean, loss: string | undefined): string {
    if (isMoving) return 'The session moved';
    if (loss !== undefined) return `Slow: ${loss}`;
    return this.isRecorded ? kRecorded : 'Connected';
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

function isBetween({ name }: ConnectionState): boolean {
  return name === 'connecting' || name === 'open';
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
