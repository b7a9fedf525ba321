/** What the view shows and how, as the user chose it. */
export type ViewSettings = { -readonly [N in ChoiceName]: Choice<N> } & Record<
  SwitchName,
  boolean
> &
  Record<NumberName, number | undefined>;

/** What can be chosen, the first by default. */
export const kChoices = {
  /** `auto`: the best that this machine draws fast enough. */
  liquid: ['auto', 'fluid', 'surface', 'splats', 'particles'],
  /** Of deformable and rigid bodies. */
  solids: ['particles', 'skin', 'both'],
  colour: ['body', 'kind', 'speed', 'density', 'pressure', 'force'],
  map: ['viridis', 'cividis', 'turbo', 'blue-red'],
  /** The axis along which what lies beyond `clipAt` is cut away. */
  clip: ['off', 'x', 'y', 'z'],
  /** Motion between frames; `auto`: unless the processor draws. */
  smooth: ['auto', 'on', 'off'],
} as const;

/** All off by default. */
export const kSwitches = [
  'clipOther',
  /** Along the velocities of particles. */
  'arrows',
  /** And centres of mass, of rigid bodies. */
  'axes',
  /** As wide as particles feel each other. */
  'cells',
  /** Of deformable bodies, by how far they are strained. */
  'springs',
  /** Between bodies, by their forces. */
  'contacts',
] as const;

/** Undefined by default. */
export const kNumbers = [
  /** The values at the ends of the colour map; undefined: as they come. */
  'from',
  'to',
  /** From 0 to 1 across the scene; undefined: in the middle. */
  'clipAt',
] as const;

export type ChoiceName = keyof typeof kChoices;
export type Choice<N extends ChoiceName> = (typeof kChoices)[N][number];
export type SwitchName = (typeof kSwitches)[number];
export type NumberName = (typeof kNumbers)[number];

const kChoiceNames = Object.keys(kChoices) as ChoiceName[];

export function defaultSettings(): ViewSettings {
  return Object.fromEntries([
    ...kChoiceNames.map((name) => [name, kChoices[name][0]]),
    ...kSwitches.map((name) => [name, false]),
    ...kNumbers.map((name) => [name, undefined]),
  ]) as unknown as ViewSettings;
}

/** In a few characters what differs from the defaults, such as "liquid:splats"; for addresses. */
export function settingsToText(settings: ViewSettings): string {
  const usual = defaultSettings();
  const names = Object.keys(usual) as (keyof ViewSettings)[];
  return names
    .filter((name) => settings[name] !== usual[name])
    .map((name) => `${name}:${settings[name]}`)
    .join(',');
}

/** Reads what settingsToText wrote; what is unknown or wrong stays at its default. */
export function settingsFromText(text: string): ViewSettings {
  const given = new Map<string, string>();
  for (const part of text.split(',')) {
    const [name = '', value = ''] = part.split(':');
    given.set(name, value);
  }
  const settings = defaultSettings();
  const choices = kChoiceNames.flatMap((name) => {
    const found = (kChoices[name] as readonly string[]).find(
      (choice) => choice === given.get(name),
    );
    return found === undefined ? [] : [[name, found]];
  });
  const switches = kSwitches.map((name) => [name, given.get(name) === 'true']);
  const numbers = kNumbers.flatMap((name) => {
    const value = parseFloat(given.get(name) ?? '');
    return Number.isFinite(value) ? [[name, value]] : [];
  });
  return Object.assign(settings, Object.fromEntries([...choices, ...switches, ...numbers]));
}
