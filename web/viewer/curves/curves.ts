import { RequestError } from '../../client/index';
import type { SessionDescription, SessionStats, SessionStatus } from '../../client/index';
import { element, make } from '../panel/elements';
import type { Desk } from '../panel/desk';
import { watchTheme } from '../view/base/theme';
import type { Chart } from './chart';
import { History } from './history';
import { diagnosticSeries, kCharts, kSeries } from './series';
import type { SeriesName } from './series';
import { StageBar } from './stage_bar';
import { profileBetween } from './stage_words';
import './curves.css';

/** The interval of requests for the session's figures while the section is open [ms]. */
const kPeriodMs = 1000;

/** Figures of the stream that the page measures. */
export interface StreamFigures {
  /** [s] */
  age: number | undefined;
  bytesPerSecond: number;
}

/** The section of curves over time and of the computing time per stage. */
export class Curves {
  private readonly section = element('curves-details', HTMLDetailsElement);
  private readonly place = element('curves-place', HTMLElement);
  private readonly history = new History<SeriesName>(kSeries);
  private readonly stages = new StageBar();
  private charts: Chart[] | undefined;
  private isLoading = false;
  private hasDiagnostics = true;
  private isJoined = false;
  private before: SessionStats | undefined;
  private tickSeconds = 1;
  private status: SessionStatus | undefined;

  constructor(
    private readonly desk: Desk,
    private readonly figures: () => StreamFigures,
  ) {
    this.place.append(this.stages.element);
    this.section.addEventListener('toggle', () => void this.look());
    window.setInterval(() => void this.look(), kPeriodMs);
    watchTheme(() => this.charts?.forEach((chart) => chart.repaint()));
  }

  enable(isJoined: boolean): void {
    this.isJoined = isJoined;
    if (!isJoined) this.before = undefined;
  }

  /** `isNew`: another scene or session. */
  describe({ tick_seconds: tickSeconds }: SessionDescription, isNew: boolean): void {
    this.tickSeconds = tickSeconds;
    if (!isNew) return;
    this.history.clear();
    this.before = undefined;
  }

  showStatus(status: SessionStatus): void {
    this.status = status;
    if (!status.playing) return;
    const { age, bytesPerSecond } = this.figures();
    this.history.add(status.time, {
      rate: status.real_time_factor,
      bytes: bytesPerSecond,
      ...(age !== undefined && { age }),
    });
  }

  /** Requests the figures and draws them if the section is open. */
  private async look(): Promise<void> {
    if (!this.section.open || document.hidden) return;
    await this.load();
    this.charts?.forEach((chart) => chart.show(this.history));
    if (!this.isJoined) return;
    const stats = await this.ask();
    if (!stats) return;
    if (stats.diagnostics) this.history.add(stats.time, diagnosticSeries(stats.diagnostics));
    const profile = profileBetween(this.before, stats);
    this.before = stats;
    if (profile) this.stages.show(profile, this.tickSeconds, this.status?.speed ?? 1);
  }

  /** Requests the figures; undefined after a failure, which the next request repeats. */
  private async ask(): Promise<SessionStats | undefined> {
    try {
      return await this.desk.request(
        'session.stats',
        this.hasDiagnostics ? { diagnostics: true } : {},
      );
    } catch (error) {
      // An older server does not know this parameter.
      if (error instanceof RequestError && error.kind === 'invalid_params') {
        this.hasDiagnostics = false;
      }
      return undefined;
    }
  }

  /** Loads the charting library on demand. */
  private async load(): Promise<void> {
    if (this.charts || this.isLoading) return;
    this.isLoading = true;
    try {
      const { Chart } = await import('./chart');
      this.charts = kCharts.map((plan) => new Chart(plan));
      this.place.append(...this.charts.map((chart) => chart.element));
    } catch {
      const words = 'The server did not send the curves. Open this section again.';
      this.place.append(make('p', { className: 'soft' }, words));
    } finally {
      this.isLoading = false;
    }
  }
}
