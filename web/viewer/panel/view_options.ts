import { kChoices } from '../view/base/settings';
import type {
  Choice,
  ChoiceName,
  NumberName,
  SwitchName,
  ViewSettings,
} from '../view/base/settings';
import { quantityOf } from '../view/colour/quantity';
import type { View } from '../view/view';
import { ColourLegend } from './colour_legend';
import { element, make } from './elements';
import { formatMilliseconds } from './format';
import './view_options.css';

type Words = { readonly [N in ChoiceName]: Readonly<Record<Choice<N>, string>> };

const kWords: Words = {
  liquid: {
    auto: 'automatic',
    fluid: 'clear liquid',
    surface: 'surface',
    splats: 'soft splats',
    particles: 'particles',
  },
  solids: {
    shape: 'surface',
    skin: 'skin around particles',
    particles: 'particles',
    both: 'skin and particles',
  },
  colour: {
    material: 'by material',
    body: 'by body',
    kind: 'by kind',
    speed: 'by speed',
    density: 'by density',
    pressure: 'by pressure',
    force: 'by force per mass',
    normals: 'by normals of clear liquids',
  },
  map: { viridis: 'viridis', cividis: 'cividis', turbo: 'turbo', 'blue-red': 'blue to red' },
  clip: { off: 'nothing', x: 'along x', y: 'along y', z: 'along z' },
  smooth: { auto: 'automatic', on: 'between frames', off: 'frame by frame' },
  orbit: { on: 'turns slowly', off: 'stands still' },
};

const kHidden = { className: 'view-words', hidden: true };

/** The update interval of the delay [ms]. */
const kDelayPeriodMs = 500;

/** The section for the view's settings. */
export class ViewOptions {
  private readonly section = make('section', { id: 'view-options', ariaLabel: 'View' });
  private readonly notice = make('p', { ...kHidden, id: 'view-notice' });
  private readonly delay = make('p', kHidden);

  constructor(private readonly view: View) {
    const isOfNumbers = ({ colour }: ViewSettings): boolean => quantityOf(colour) !== undefined;
    const isClipped = ({ clip }: ViewSettings): boolean => clip !== 'off';
    this.section.append(
      this.choice('liquid', 'Liquid'),
      this.choice('solids', 'Other bodies'),
      this.choice('colour', 'Colour'),
      this.only(isOfNumbers, this.choice('map', 'Colour map')),
      this.only(isOfNumbers, this.range()),
      this.choice('clip', 'Cut away'),
      this.only(isClipped, this.slider('clipAt', 'Cut at')),
      this.only(isClipped, this.toggle('clipOther', 'Opposite side')),
      this.toggle('arrows', 'Velocity arrows'),
      this.toggle('axes', 'Axes of rigid bodies'),
      this.toggle('cells', 'Cells'),
      this.toggle('springs', 'Springs by strain'),
      this.toggle('contacts', 'Contacts by force'),
      this.choice('smooth', 'Motion'),
      this.choice('orbit', 'Idle camera'),
      this.delay,
      this.notice,
    );
  }

  /** Inserts the section into its placeholder, or at the end of the panel. */
  mount(): void {
    const place = document.getElementById('view-place') ?? element('panel', HTMLElement);
    place.append(this.section);
    element('stage', HTMLElement).append(new ColourLegend(this.view.scale).element);
    this.view.onWords((text) => write(this.notice, text.join(' ') || undefined));
    window.setInterval(() => this.showDelay(), kDelayPeriodMs);
  }

  private showDelay(): void {
    const { delaySeconds } = this.view;
    const text = `Shown with a delay of ${formatMilliseconds(delaySeconds)}, for smooth motion.`;
    write(this.delay, delaySeconds > 0 ? text : undefined);
  }

  private choice<N extends ChoiceName>(name: N, label: string): HTMLElement {
    const picker = make('select', { id: `view-${name}` });
    const texts: Readonly<Record<string, string>> = kWords[name];
    for (const value of kChoices[name]) picker.add(new Option(texts[value], value));
    this.bind(picker, () => ({ [name]: picker.value as Choice<N> }));
    this.view.settings.subscribe((now) => (picker.value = now[name]));
    return row(label, picker);
  }

  private toggle(name: SwitchName, label: string): HTMLElement {
    const box = make('input', { type: 'checkbox', id: `view-${name}` });
    this.bind(box, () => ({ [name]: box.checked }));
    this.view.settings.subscribe((now) => (box.checked = now[name]));
    return row(label, box);
  }

  private slider(name: NumberName, label: string): HTMLElement {
    const slider = make('input', { type: 'range', id: `view-${name}` });
    [slider.min, slider.max, slider.step] = ['0', '1', '0.01'];
    this.bind(slider, () => ({ [name]: slider.valueAsNumber }), 'input');
    this.view.settings.subscribe((now) => (slider.value = String(now[name] ?? 0.5)));
    return row(label, slider);
  }

  /** Returns the controls for the ends of the colour map: fixed or automatic. */
  private range(): HTMLElement {
    const [from, to] = (['from', 'to'] as const).map((name) => {
      const field = make('input', {
        type: 'number',
        step: 'any',
        id: `view-${name}`,
        placeholder: 'auto',
        ariaLabel: `Colours ${name}`,
      });
      this.bind(field, () => ({
        [name]: Number.isFinite(field.valueAsNumber) ? field.valueAsNumber : undefined,
      }));
      this.view.settings.subscribe((now) => (field.value = String(now[name] ?? '')));
      return field;
    });
    const group = make('span', { className: 'view-range' }, from!, '–', to!);
    const whole = row('Range', group);
    whole.title = 'Values at the ends of the colour map; empty: minimum and maximum';
    return whole;
  }

  private bind(
    control: HTMLElement,
    read: () => Partial<ViewSettings>,
    event: 'change' | 'input' = 'change',
  ): void {
    control.addEventListener(event, () => this.view.settings.change(read()));
  }

  private only(isShown: (settings: ViewSettings) => boolean, part: HTMLElement): HTMLElement {
    this.view.settings.subscribe((now) => (part.hidden = !isShown(now)));
    return part;
  }
}

function row(label: string, control: HTMLElement): HTMLElement {
  const tag = control.tagName === 'SPAN' ? 'div' : 'label';
  return make(tag, { className: 'view-row' }, label, control);
}

function write(to: HTMLElement, text: string | undefined): void {
  to.textContent = text ?? '';
  to.hidden = text === undefined;
}
