import { make } from '../panel/elements';
import { formatSeconds } from '../panel/format';

/** From the first to the last position of a recording [ticks], and how long a tick is [s]. */
export interface Span {
  begin: number;
  end: number;
  tickSeconds: number;
}

/** Where a replay is, and where it differed from what was recorded; the slider goes anywhere. */
export class Timeline {
  readonly element: HTMLElement;
  private readonly slider = make('input', {
    type: 'range',
    id: 'replay-position',
    min: '0',
    step: '1',
    ariaLabel: 'Position in the recording',
  });
  private readonly text = make('output', { id: 'replay-time' });
  private readonly mark = make('i', { id: 'replay-mark', hidden: true });
  private span: Span = { begin: 0, end: 1, tickSeconds: 1 };
  private isDragging = false;

  constructor(seek: (position: number) => void) {
    const track = make('span', { className: 'track' }, this.slider, this.mark);
    this.element = make('div', { className: 'timeline' }, track, this.text);
    this.slider.addEventListener('input', () => {
      this.isDragging = true;
      this.write();
      seek(this.span.begin + this.slider.valueAsNumber);
    });
    this.slider.addEventListener('change', () => (this.isDragging = false));
  }

  /** Of another recording. */
  describe(span: Span): void {
    this.span = span;
    this.slider.max = String(span.end - span.begin);
    this.write();
  }

  /** Where it is; a slider that is held stays in the hand. */
  show(position: number): void {
    if (this.isDragging) return;
    this.slider.valueAsNumber = position - this.span.begin;
    this.slider.dataset.position = String(position);
    this.write();
  }

  /** Where what was computed is not what was recorded; undefined: nowhere. */
  showDivergence(position: number | undefined): void {
    this.mark.hidden = position === undefined;
    const { begin, end } = this.span;
    const share = ((position ?? begin) - begin) / Math.max(end - begin, 1);
    this.mark.style.left = `${(100 * share).toFixed(2)}%`;
  }

  private write(): void {
    const { begin, end, tickSeconds } = this.span;
    const at = formatSeconds(this.slider.valueAsNumber * tickSeconds);
    const whole = formatSeconds((end - begin) * tickSeconds);
    this.text.value = `${at} of ${whole}`;
    this.slider.ariaValueText = this.text.value;
  }
}
