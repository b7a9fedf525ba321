import type { Participant, RoleName } from '../../client/index';
import { element, make, makeButton, onPress } from '../panel/elements';
import { personColour } from '../stream/people';
import type { People } from '../stream/people';

export interface PeopleActions {
  rename(name: string): void;
  ask(): void;
  handOver(participant: number): void;
  setRole(participant: number, role: 'viewer' | 'controller' | 'owner'): void;
  kick(participant: number): void;
  lock(locked: boolean): void;
  /** Returns the name of a body, for the list of held bodies. */
  nameOfBody(body: number): string;
}

const kRoles: Readonly<Record<RoleName, string>> = {
  viewer: 'watches',
  controller: 'controls',
  owner: 'owner',
  admin: 'admin',
};

/** The list of participants with roles, held bodies and actions. */
export class PeopleList {
  private readonly list = element('people', HTMLElement);
  private readonly count = element('people-count', HTMLElement);
  private readonly name = element('rename-name', HTMLInputElement);
  private readonly asker = element('control-request', HTMLButtonElement);
  private readonly lockRow = element('lock-row', HTMLElement);
  private readonly lockBox = element('lock', HTMLInputElement);
  private written = '';

  constructor(
    private readonly people: People,
    private readonly actions: PeopleActions,
  ) {
    people.subscribe(() => this.show());
    onPress(this.asker, () => actions.ask());
    this.lockBox.addEventListener('change', () => actions.lock(this.lockBox.checked));
    element('rename', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      const name = this.name.value.trim();
      if (name !== '') actions.rename(name);
    });
  }

  enable(enabled: boolean): void {
    this.name.disabled = !enabled;
  }

  private show(): void {
    const { people } = this;
    const here = people.all.filter(({ away }) => !away).length;
    this.count.textContent = String(here);
    if (people.self && document.activeElement !== this.name) this.name.value = people.self.name;
    this.asker.hidden = people.isInControl;
    this.lockRow.hidden = !people.isOwner;
    this.lockBox.checked = people.settings?.locked ?? false;
    this.write();
  }

  /** Updates the list if it has changed, because pointers move continually. */
  private write(): void {
    const { all, self } = this.people;
    const shown = all.map(({ participant, name, role, away, grabs }) =>
      JSON.stringify([participant, name, role, away, grabs, self?.participant, self?.role]),
    );
    if (shown.join() === this.written) return;
    this.written = shown.join();
    this.list.replaceChildren(...all.map((person) => this.item(person)));
  }

  private item(person: Participant): HTMLElement {
    const dot = make('i');
    dot.style.background = personColour(person.participant);
    const isSelf = person.participant === this.people.self?.participant;
    const item = make(
      'li',
      {},
      dot,
      span('who', isSelf ? `${person.name} (you)` : person.name),
      span('role', person.away ? 'away' : kRoles[person.role]),
    );
    item.dataset.participant = String(person.participant);
    item.dataset.away = String(person.away);
    if (person.grabs.length > 0) {
      const names = person.grabs.map((body) => this.actions.nameOfBody(body));
      item.append(span('does', `holds ${names.join(', ')}`));
    }
    const acts = isSelf ? [] : this.actsOn(person);
    if (acts.length > 0) item.append(span('acts', ...acts));
    return item;
  }

  private actsOn({ participant, role, name }: Participant): HTMLElement[] {
    const { people, actions } = this;
    if (people.isOwner && role !== 'admin') {
      const picker = make('select', { ariaLabel: `Role of ${name}` });
      picker.add(new Option('watches', 'viewer'));
      picker.add(new Option('controls', 'controller'));
      picker.add(new Option('owns the session', 'owner'));
      picker.value = role;
      picker.addEventListener('change', () =>
        actions.setRole(participant, picker.value as 'viewer' | 'controller' | 'owner'),
      );
      return [picker, makeButton('Remove', () => actions.kick(participant), `Remove ${name}`)];
    }
    if (people.isInControl && role === 'viewer') {
      const label = `Give control to ${name}`;
      return [makeButton('Give control', () => actions.handOver(participant), label)];
    }
    return [];
  }
}

function span(className: string, ...content: (Node | string)[]): HTMLElement {
  return make('span', { className }, ...content);
}
