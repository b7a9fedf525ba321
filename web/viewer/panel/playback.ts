import { element, onPress } from './elements';
import { formatFactor } from './format';
import type { Keys } from './keys';

export interface PlaybackActions {
  play(): void;
  pause(): void;
  step(): void;
  reset(): void;
  setSpeed(speed: number): void;
}

/** Play, pause, step, reset, speed, and their keys. */
export class Playback {
  private readonly playButton = element('play', HTMLButtonElement);
  private readonly stepButton = element('step', HTMLButtonElement);
  private readonly resetButton = element('reset', HTMLButtonElement);
  private readonly slider = element('speed', HTMLInputElement);
  private readonly speedText = element('speed-text', HTMLOutputElement);
  private enabled = false;
  private playing = false;
  private dragging = false;

  constructor(
    private readonly actions: PlaybackActions,
    keys: Keys,
  ) {
    onPress(this.playButton, () => this.toggle());
    onPress(this.stepButton, () => actions.step());
    onPress(this.resetButton, () => actions.reset());
    this.slider.addEventListener('input', () => this.dragSpeed());
    this.slider.addEventListener('change', () => this.finishSpeed());
    this.addKeys(keys);
  }

  /** `canReset`: whether the session can be reset. */
  enable(enabled: boolean, canReset: boolean): void {
    this.enabled = enabled;
    for (const control of [this.playButton, this.stepButton, this.slider]) {
      control.disabled = !enabled;
    }
    this.resetButton.disabled = !enabled || !canReset;
  }

  showPlaying(playing: boolean): void {
    this.playing = playing;
    this.playButton.dataset.playing = String(playing);
    this.playButton.firstChild!.textContent = playing ? 'Pause ' : 'Play ';
  }

  showSpeed(speed: number): void {
    if (this.dragging) return;
    this.slider.value = String(Math.log2(speed));
    this.writeSpeed(speed);
  }

  private writeSpeed(speed: number): void {
    this.speedText.value = formatFactor(speed);
    this.slider.ariaValueText = `${speed.toFixed(2)} times real time`; // the value is logarithmic
  }

  /** Switches between playing and pausing. */
  toggle(): void {
    if (this.playing) this.actions.pause();
    else this.actions.play();
  }

  private dragSpeed(): void {
    this.dragging = true;
    this.writeSpeed(sliderSpeed(this.slider.valueAsNumber));
  }

  private finishSpeed(): void {
    this.dragging = false;
    this.actions.setSpeed(sliderSpeed(this.slider.valueAsNumber));
  }

  private addKeys(keys: Keys): void {
    const isEnabled = (): boolean => this.enabled;
    keys.add({
      keys: [' '],
      sign: 'space',
      words: 'play, pause',
      act: () => this.toggle(),
      isEnabled,
    });
    const { step, reset } = this.actions;
    keys.add({ keys: ['s'], sign: 'S', words: 'one tick', repeats: true, act: step, isEnabled });
    keys.add({
      keys: ['r'],
      sign: 'R',
      words: 'back to the start',
      act: reset,
      isEnabled: () => !this.resetButton.disabled,
    });
    keys.add({
      keys: [',', '.'],
      sign: ', .',
      words: 'slower, faster',
      repeats: true,
      act: (key) => this.nudgeSpeed(key === '.' ? 1 : -1),
      isEnabled,
    });
  }

  /** Changes the speed by a factor of √2. */
  private nudgeSpeed(direction: 1 | -1): void {
    this.slider.valueAsNumber += direction / 2;
    this.writeSpeed(sliderSpeed(this.slider.valueAsNumber));
    this.finishSpeed();
  }
}

/**
 * Returns the speed of a position of the slider, in tenths of an octave. The rounding of the speed is
 * smaller than a step, so that setting the slider to this speed returns the same position.
 */
export function sliderSpeed(position: number): number {
  const speed = 2 ** position;
  const step = speed < 0.2 ? 0.001 : speed < 1 ? 0.01 : 0.05;
  return Math.min(Math.max(Math.round(speed / step) * step, 0.05), 4);
}
