import type { SessionStats } from '../../client/index';

/** Groups of stages: their text, and the stages that belong to them. */
const kGroups: Readonly<Record<string, readonly string[]>> = {
  'finding neighbours': ['find_pairs', 'list_neighbours', 'sort_liquid', 'sort_solids'],
  'forces in liquids': [
    'liquid_density',
    'liquid_pressure',
    'liquid_forces',
    'viscous_images',
    'find_surface',
    'surface_normals',
    'surface_tension',
    'cohesion',
    'adhesion',
  ],
  'pressure of liquids': [
    'recall_pressure',
    'project_velocities',
    'correct_density',
    'cell_pressure',
    'cell_forces',
  ],
  'liquids and bodies': ['solid_pressure', 'liquid_forces_on_solids'],
  'contacts and walls': ['find_contacts', 'contacts', 'project_contacts', 'walls', 'hold_inside'],
  'springs of deformable bodies': [
    'springs',
    'change_springs',
    'limit_elongation',
    'implicit_springs',
    'implicit_dashpots',
    'bound_damping',
    'solve_damping',
  ],
  'moving particles': [
    'external_forces',
    'predict_velocities',
    'kick',
    'drift',
    'pose_rigid_bodies',
    'gather_rigid_forces',
    'sleep',
    'change_bodies',
  ],
  'checks of each step': ['guard', 'keep_state'],
};

const kOther = 'other work';

/** A part of the time of a tick. */
export interface Part {
  words: string;
  /** [s] per tick. */
  seconds: number;
  /** Share of the total. */
  share: number;
}

export interface TickProfile {
  /** Wall time of a tick [s]. */
  seconds: number;
  /** The parts in descending order. */
  parts: Part[];
}

/** Returns the mean time per tick between two requests by part; undefined without ticks. */
export function profileBetween(
  before: SessionStats | undefined,
  now: SessionStats,
): TickProfile | undefined {
  const isSame = before !== undefined && now.ticks >= before.ticks; // false after a restart of the count
  const ticks = now.ticks - (isSame ? before.ticks : 0);
  if (ticks <= 0) return undefined;
  const earlier = new Map(
    isSame ? before.stages.map(({ stage, seconds }) => [stage, seconds]) : [],
  );
  const sums = new Map<string, number>();
  for (const { stage, seconds } of now.stages) {
    const words = wordsOf(stage);
    const spent = Math.max(seconds - (earlier.get(stage) ?? 0), 0) / ticks;
    sums.set(words, (sums.get(words) ?? 0) + spent);
  }
  const all = [...sums.values()].reduce((sum, seconds) => sum + seconds, 0);
  const parts = [...sums]
    .map(([words, seconds]) => ({ words, seconds, share: all > 0 ? seconds / all : 0 }))
    .sort((a, b) => b.seconds - a.seconds);
  const seconds = (now.seconds - (isSame ? before.seconds : 0)) / ticks;
  return { seconds, parts };
}

function wordsOf(stage: string): string {
  const found = Object.entries(kGroups).find(([, stages]) => stages.includes(stage));
  return found?.[0] ?? kOther;
}

/** Returns a text on the server's speed and its main costs. `tickSeconds`: simulated time per tick. */
export function profileInWords(
  { seconds, parts }: TickProfile,
  tickSeconds: number,
  speed: number,
): string {
  const allowed = tickSeconds / speed;
  const rounded = (value: number): number => Number(value.toPrecision(2));
  const milliseconds = (value: number): string => `${rounded(1000 * value)} ms`;
  const [first] = parts;
  const most = first
    ? ` The largest part is ${first.words}: ${Math.round(100 * first.share)} %.`
    : '';
  const enough = seconds <= allowed;
  const verdict = enough
    ? 'so the speed is reached.'
    : `so the simulation runs ${rounded(seconds / allowed)} times slower than the set speed. Use fewer particles or a lower speed.`;
  return `A tick takes ${milliseconds(seconds)} of the ${milliseconds(allowed)} that it may take, ${verdict}${most}`;
}
