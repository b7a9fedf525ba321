import type { ConnectionState, FrameHeader } from '../../client/index';
import { element, onPress } from './elements';
import { rateInWords } from './quality';

const kConnected = 'Connected';

/** The connection's state in words, and a button with a count-down to the next attempt. */
export class ConnectionLine {
  private readonly line = element('connection', HTMLElement);
  private readonly text = element('connection-text', HTMLElement);
  private readonly retry = element('connection-retry', HTMLButtonElement);
  private countdown: number | undefined;

  constructor(retryNow: () => void) {
    onPress(this.retry, retryNow);
  }

  show(state: ConnectionState): void {
    window.clearInterval(this.countdown);
    this.line.dataset.state = state.name;
    this.retry.hidden = state.name !== 'waiting';
    this.text.textContent = words(state);
    if (state.name === 'waiting') this.countDown(state.retryMs);
  }

  /** Says where this viewer does not get all frames: the line, or what draws here, is too slow. */
  showFrame({ stride }: FrameHeader): void {
    const text = stride === 1 ? kConnected : `${kConnected}, but slow: ${rateInWords(stride)}`;
    if (this.text.textContent !== text) this.text.textContent = text;
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

function words(state: ConnectionState): string {
  switch (state.name) {
    case 'connecting':
      return 'Connecting …';
    case 'open':
      return kConnected;
    case 'waiting':
      return `Not connected: ${state.reason}`;
    case 'closed':
      return state.reason === undefined ? 'Not connected' : `Not connected: ${state.reason}`;
  }
}
