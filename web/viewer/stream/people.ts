import type { Events, JoinedAs, Participant, SessionSettings } from '../../client/index';

/** Colours by participant number, with sufficient contrast to white text. */
const kColours = ['#1f6fd0', '#b4371f', '#1d7a45', '#8a3fb0', '#8a5a00', '#0c7285', '#b0246a'];

export function personColour(participant: number): string {
  return kColours[participant % kColours.length]!;
}

/** The participants of the session. Subscribers are notified of each change. */
export class People {
  private readonly byNumber = new Map<number, Participant>();
  private readonly listeners: (() => void)[] = [];
  private ours: number | undefined;
  private current: SessionSettings | undefined;
  /** The name of the session. */
  session = '';

  join({ participant, participants, settings, session }: JoinedAs): void {
    this.byNumber.clear();
    for (const person of participants) this.byNumber.set(person.participant, person);
    this.ours = participant;
    this.current = settings;
    this.session = session;
    this.tell();
  }

  change({ participants, left }: Events['presence.changed']): void {
    for (const person of participants) this.byNumber.set(person.participant, person);
    for (const number of left) this.byNumber.delete(number);
    this.tell();
  }

  configure(settings: SessionSettings): void {
    this.current = settings;
    this.tell();
  }

  subscribe(listener: () => void): void {
    this.listeners.push(listener);
  }

  get all(): readonly Participant[] {
    return [...this.byNumber.values()];
  }

  get others(): readonly Participant[] {
    return this.all.filter(({ participant }) => participant !== this.ours);
  }

  get self(): Participant | undefined {
    return this.ours === undefined ? undefined : this.byNumber.get(this.ours);
  }

  get settings(): SessionSettings | undefined {
    return this.current;
  }

  /** Whether the user can control the session. */
  get isInControl(): boolean {
    return this.self !== undefined && this.self.role !== 'viewer';
  }

  /** Whether the user is the owner, who assigns roles. */
  get isOwner(): boolean {
    return this.self?.role === 'owner' || this.self?.role === 'admin';
  }

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
