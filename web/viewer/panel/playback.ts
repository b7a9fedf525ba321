import { element, onPress } from './elements';
import { formatFactor } from './format';

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

  constructor(private readonly actions: PlaybackActions) {
    onPress(this.playButton, () => this.toggle());
    onPress(this.stepButton, () => actions.step());
    onPress(this.resetButton, () => actions.reset());
    this.slider.addEventListener('input', () => this.dragSpeed());
    this.slider.addEventListener('change', () => this.finishSpeed());
    window.addEventListener('keydown', (event) => this.handleKey(event));
  }

  enable(enabled: boolean): void {
    this.enabled = enabled;
    for (const control of [this.playButton, this.stepButton, this.resetButton, this.slider]) {
      control.disabled = !enabled;
    }
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
    this.slider.ariaValueText = `${speed.toFixed(2)} times real time`; // its value is a logarithm
  }

  private toggle(): void {
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

  private handleKey(event: KeyboardEvent): void {
    const { target, repeat } = event;
    const key = event.key.toLowerCase(); // Caps Lock makes no difference
    const isPlain = !event.ctrlKey && !event.altKey && !event.metaKey;
    if (!this.enabled || !isPlain || isControl(target, key)) return;
    if (key === ' ' && !repeat) this.toggle();
    else if (key === 's') this.actions.step();
    else if (key === 'r' && !repeat) this.actions.reset();
    else return;
    event.preventDefault();
  }
}

/** Whether the key means something to the control that has the focus. */
function isControl(target: EventTarget | null, key: string): boolean {
  if (target instanceof HTMLButtonElement) return key === ' ';
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}

/**
 * The slider is logarithmic, in tenths of a doubling, and the speed is rounded less than that: a
 * slider set to the speed that it gave stays where it is.
 */
export function sliderSpeed(position: number): number {
  const speed = 2 ** position;
  const step = speed < 0.2 ? 0.001 : speed < 1 ? 0.01 : 0.05;
  return Math.min(Math.max(Math.round(speed / step) * step, 0.05), 4);
}
