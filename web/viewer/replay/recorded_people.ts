import type { RecordedPeople } from '../../client/index';
import { element, make } from '../panel/elements';
import { Labels } from '../people/labels';
import { personColour } from '../people/people';
import type { Stage } from '../view/stage';

/** Who took part when it was recorded: what they held, and where they drew it to. */
export class RecordedCompany {
  readonly list = make('ul', { id: 'replay-people', ariaLabel: 'Recorded participants' });
  private readonly labels: Labels;
  private people: RecordedPeople = [];

  constructor(
    stage: Stage,
    private readonly nameOfBody: (body: number) => string,
  ) {
    this.labels = new Labels(element('cursors', HTMLElement), stage, 'recorded');
  }

  show(people: RecordedPeople): void {
    this.people = people;
    this.list.replaceChildren(...people.map((person) => this.item(person)));
    this.update();
  }

  /** Puts the names where the camera sees them now. */
  update(): void {
    this.labels.show(
      this.people.flatMap(({ person: key, name: text, pointer }) =>
        pointer ? [{ key, text, colour: personColour(key), position: pointer.position }] : [],
      ),
    );
  }

  private item({ person, name, grabs }: RecordedPeople[number]): HTMLElement {
    const dot = make('i');
    dot.style.background = personColour(person);
    const held = grabs.map((body) => this.nameOfBody(body)).join(', ');
    return make('li', {}, dot, held === '' ? name : `${name} holds ${held}`);
  }
}
