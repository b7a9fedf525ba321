import type { RecordedPeople } from '../../client/index';
import { element, make } from '../panel/elements';
import { Labels } from '../people/labels';
import { personColour } from '../stream/people';
import type { Stage } from '../view/stage';

/** The recorded participants: their held bodies and targets. */
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

  /** Moves the names to their present positions in the picture. */
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
