import type { Event, MethodName, Params, RoleName } from '../../client/index';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import type { View } from '../view/view';
import { Cursors } from './cursors';
import { GovernorRow } from './governor_row';
import { People } from '../stream/people';
import { PeopleList } from './people_list';
import { Share } from './share';
import type { Outlook } from './share';

/** The functions for several users: the list of participants, pointers, and sharing. */
export class Company {
  readonly people = new People();
  readonly cursors: Cursors;
  readonly share: Share;
  private readonly list: PeopleList;

  constructor(
    view: View,
    private readonly desk: Desk,
    nameOfBody: (body: number) => string,
    shown: Pick<Outlook, 'moment' | 'recording'>,
  ) {
    this.list = new PeopleList(this.people, {
      rename: (name) => this.call('participant.rename', { name }),
      ask: () => this.askForControl(),
      handOver: (participant) => this.giveControl(participant),
      setRole: (participant, role) => this.call('participant.set_role', { participant, role }),
      kick: (participant) => this.call('participant.kick', { participant }),
      lock: (locked) => this.call('session.configure', { locked }),
      nameOfBody,
    });
    new GovernorRow(this.people, desk);
    const { canvas } = view.stage;
    this.cursors = new Cursors(this.people, view.stage, view.world, (position) => {
      // A lost pointer position does not matter, because the next one follows.
      if (canvas.dataset.joined !== 'true') return;
      void desk.request('presence.point', position ? { position } : {}).catch(() => undefined);
    });
    const outlook = {
      get pose() {
        return view.stage.pose;
      },
      get view() {
        return view.settings.text;
      },
      get moment() {
        return shown.moment;
      },
      get recording() {
        return shown.recording;
      },
    };
    this.share = new Share(this.people, outlook, desk);
  }

  handle({ event, params }: Event): void {
    if (event === 'session.configured') this.people.configure(params);
    if (event !== 'presence.changed') return;
    const before = this.people.self?.role;
    this.people.change(params);
    const words = changeInWords(before, this.people.self?.role);
    if (words !== undefined) this.desk.say(words);
  }

  askForControl(): void {
    this.call('control.request', {}, 'Your request was sent.');
  }

  /** Gives control to a participant. Owners keep their role; others become viewers. */
  giveControl(participant: number): void {
    this.call('control.hand_over', { participant });
  }

  /** `canShare`: whether a link can open what the page shows. */
  enable(enabled: boolean, canShare: boolean): void {
    this.list.enable(enabled);
    this.share.enable(canShare);
  }

  private call<M extends MethodName>(method: M, params: Params<M>, done?: string): void {
    void ask(this.desk, method, params).then((answer) => answer && done && this.desk.say(done));
  }
}

/** Returns the effect of a change of the user's role as text. */
function changeInWords(
  before: RoleName | undefined,
  after: RoleName | undefined,
): string | undefined {
  if (before === undefined || after === undefined || before === after) return undefined;
  if (after === 'viewer')
    return 'You are a viewer now. To change the scene, ask for control under People.';
  if (after === 'owner') return 'You are the owner of this session now.';
  return before === 'viewer' ? 'You are a controller now.' : undefined;
}
