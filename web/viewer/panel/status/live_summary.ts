import type {
  ConnectionState,
  FrameHeader,
  SessionDescription,
  SessionStatus,
} from '../../../client/index';
import type { People } from '../../stream/people';
import { now } from '../../stream/clock';
import { Summary } from './summary';

/** The update interval of the text [ms]. */
const kPeriodMs = 500;

/** Collects the state for the live text. */
export class LiveSummary {
  private readonly summary = new Summary();
  private isConnected = false;
  private isEnded = false;
  private hasPicture = false;
  private playing = false;
  private speed = 1;
  private factor = 1;
  private reducedError: number | undefined;
  private people: People | undefined;
  private scene = 'No scene';
  private held: string | undefined;
  private isSlow = false;
  private shownAt = now();

  constructor() {
    window.setInterval(() => this.write(), kPeriodMs);
  }

  enable(isConnected: boolean): void {
    this.isConnected = isConnected;
    this.write();
  }

  showConnection({ name }: ConnectionState): void {
    this.isEnded = name === 'closed';
  }

  describe({ title, scene, playing, speed }: SessionDescription): void {
    this.scene = title || scene;
    [this.playing, this.speed] = [playing, speed];
    this.shownAt = now();
  }

  showStatus({ playing, speed, real_time_factor, governor }: SessionStatus): void {
    [this.playing, this.speed, this.factor] = [playing, speed, real_time_factor];
    this.reducedError = governor && governor.point > 0 ? governor.error : undefined;
    this.write();
  }

  showPeople(people: People): void {
    this.people = people;
  }

  /** Sets the body that the keyboard holds. */
  showHeld(name: string | undefined): void {
    this.held = name;
    this.write();
  }

  /** Called after drawing a frame. */
  showFrame({ slow }: FrameHeader): void {
    this.hasPicture = true;
    this.isSlow = slow;
    this.shownAt = now();
  }

  private write(): void {
    const { people } = this;
    this.summary.show({
      isConnected: this.isConnected,
      isEnded: this.isEnded,
      hasPicture: this.hasPicture,
      playing: this.playing,
      speed: this.speed,
      slow: this.isSlow,
      factor: this.factor,
      reducedError: this.reducedError,
      scene: this.scene,
      people: people?.all.filter(({ away }) => !away).length ?? 0,
      role: people?.self?.role,
      held: this.held,
      silentSeconds: now() - this.shownAt,
    });
  }
}
