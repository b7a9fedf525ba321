/** The user's settings of the view. */
export type ViewSettings = { -readonly [N in ChoiceName]: Choice<N> } & Record<
  SwitchName,
  boolean
> &
  Record<NumberName, number | undefined>;

/** The choices; the first is the default. */
export const kChoices = {
  /** `auto`: the best style that this machine draws fast enough. */
  liquid: ['auto', 'fluid', 'surface', 'splats', 'particles'],
  /** Style of deformable and rigid bodies. */
  solids: ['shape', 'skin', 'particles', 'both'],
  /** `normals`: the directions of the surfaces of clear liquids, as red, green and blue. */
  colour: ['material', 'body', 'kind', 'speed', 'density', 'pressure', 'force', 'normals'],
  map: ['viridis', 'cividis', 'turbo', 'blue-red'],
  /** The axis of the clip plane at `clipAt`. */
  clip: ['off', 'x', 'y', 'z'],
  /** Interpolation between frames; `auto`: unless the CPU draws. */
  smooth: ['auto', 'on', 'off'],
  /** Whether the camera orbits the scene slowly if the user gives no input. */
  orbit: ['on', 'off'],
} as const;

/** Switches, off by default. */
export const kSwitches = [
  'clipOther',
  /** Arrows along the velocities of particles. */
  'arrows',
  /** Axes and centres of mass of rigid bodies. */
  'axes',
  /** Search cells, one support radius wide. */
  'cells',
  /** Springs of deformable bodies, coloured by strain. */
  'springs',
  /** Contacts between bodies, coloured by force. */
  'contacts',
] as const;

/** Numbers, undefined by default. */
export const kNumbers = [
  /** The values at the ends of the colour map; undefined: automatic. */
  'from',
  'to',
  /** Position of the clip plane, 0 to 1 across the scene; undefined: the centre. */
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

/** Returns the settings that differ from the defaults, such as "liquid:splats"; for addresses. */
export function settingsToText(settings: ViewSettings): string {
  const usual = defaultSettings();
  const names = Object.keys(usual) as (keyof ViewSettings)[];
  return names
    .filter((name) => settings[name] !== usual[name])
    .map((name) => `${name}:${settings[name]}`)
    .join(',');
}

/** Reads a text of settingsToText. Unknown or invalid settings keep their defaults. */
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
