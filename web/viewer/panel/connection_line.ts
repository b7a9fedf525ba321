import type { ConnectionState } from '../../client/index';
import { element, onPress } from './elements';

/** The connection's state in words, with a count-down to the next attempt. */
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
    if (state.name === 'waiting') this.countDown(state.reason, state.retryMs);
    else this.text.textContent = words(state);
  }

  private countDown(reason: string, retryMs: number): void {
    const end = performance.now() + retryMs;
    const show = (): void => {
      const seconds = Math.max(1, Math.ceil((end - performance.now()) / 1000));
      this.text.textContent = `Not connected: ${reason}. Next try in ${seconds} s.`;
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
      return 'Connected';
    default:
      return 'Not connected';
  }
}
