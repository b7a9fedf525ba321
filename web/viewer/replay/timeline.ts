import { make } from '../panel/elements';
import { formatSeconds } from '../panel/format';

/** First and last position of a recording [ticks], and the duration of a tick [s]. */
export interface Span {
  begin: number;
  end: number;
  tickSeconds: number;
}

/** The position of a replay and of its first difference. The slider seeks. */
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

  /** Sets the recording. */
  describe(span: Span): void {
    this.span = span;
    this.slider.max = String(span.end - span.begin);
    this.write();
  }

  /** Shows the position, unless the user drags the slider. */
  show(position: number): void {
    if (this.isDragging) return;
    this.slider.valueAsNumber = position - this.span.begin;
    this.slider.dataset.position = String(position);
    this.write();
  }

  /** Shows the first difference from the recording; undefined: none. */
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
