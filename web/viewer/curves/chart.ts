import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { make } from '../panel/elements';
import type { History } from './history';
import type { ChartPlan, SeriesName } from './series';

const kHeight = 112;
/** The width of a digit [px] at the font size. */
const kDigitWidth = 6.5;
const kBesideNumbers = 14;
const kFont = '11px system-ui, sans-serif';

/** Returns the width of the longest number, including its margin [px]. */
function widthOf(_: uPlot, numbers: string[] | null): number {
  return kBesideNumbers + kDigitWidth * Math.max(0, ...(numbers ?? []).map((text) => text.length));
}

/** A chart with title and newest values; loaded on demand. */
export class Chart {
  readonly element: HTMLElement;
  private readonly newest = make('output');
  private readonly place = make('div', { className: 'chart', role: 'img' });
  private readonly plot: uPlot;

  constructor(private readonly plan: ChartPlan) {
    const { title, explanation, series } = plan;
    const name = make('b', { title: explanation }, title);
    this.element = make('figure', { className: 'curve' });
    this.element.append(make('figcaption', {}, name, this.newest), this.place);
    if (series.length > 1) this.element.append(this.legend());
    this.plot = new uPlot(this.options(), [[], ...series.map(() => [])], this.place);
    new ResizeObserver(() => this.resize()).observe(this.place);
  }

  show(history: History<SeriesName>): void {
    const { series, format, title, isSpecial } = this.plan;
    this.plot.setData(history.columns(series.map(({ name }) => name)));
    const values = series.flatMap(({ name, label }) => {
      const value = history.newest(name);
      if (value === undefined) return [];
      return [series.length > 1 ? `${label} ${format(value)}` : format(value)];
    });
    this.element.hidden = isSpecial === true && values.length === 0;
    this.newest.value = series.length > 1 ? '' : (values[0] ?? '–');
    this.place.ariaLabel = `${title} over simulated time; now ${values.join(', ') || 'unknown'}`;
    this.place.dataset.samples = String(this.plot.data[0].length);
  }

  /** Redraws in the page's present colours. */
  repaint(): void {
    this.plot.redraw(false, true);
  }

  private legend(): HTMLElement {
    const items = this.plan.series.map(({ label, colour }) => {
      const dot = make('i');
      dot.style.background = colour;
      return make('li', {}, dot, label);
    });
    return make('ul', { className: 'curve-legend' }, ...items);
  }

  private options(): uPlot.Options {
    const { series, format } = this.plan;
    const ink = (): string => getComputedStyle(this.place).color;
    const line = (): string => getComputedStyle(this.place).borderTopColor;
    const grid = { stroke: line, width: 1 };
    const axis = { stroke: ink, font: kFont, grid, ticks: { ...grid, size: 4 } };
    return {
      width: 280,
      height: kHeight,
      legend: { show: false },
      cursor: { show: false },
      padding: [8, 16, 0, 0],
      scales: { x: { time: false }, y: { range: { min: { soft: 0, mode: 1 }, max: {} } } },
      axes: [
        { ...axis, size: 24, values: (_, ticks) => ticks.map((t) => `${t} s`) },
        { ...axis, size: widthOf, space: 26, values: (_, ticks) => ticks.map((v) => format(v)) },
      ],
      series: [
        {},
        ...series.map(({ label, colour }) => ({
          label,
          stroke: colour,
          width: 1.75,
          spanGaps: true,
          points: { show: false },
        })),
      ],
    };
  }

  private resize(): void {
    const { clientWidth } = this.place;
    if (clientWidth > 0) this.plot.setSize({ width: clientWidth, height: kHeight });
  }
}
