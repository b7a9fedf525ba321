import type { Diagnostics } from '../../client/index';
import { formatQuantity } from '../view/colour/quantity';
import { formatBytes, formatFactor, formatMilliseconds } from '../panel/format';

/** The names of the curves. */
export type SeriesName =
  | 'kinetic'
  | 'gravitational'
  | 'elastic'
  | 'contact'
  | 'momentum'
  | 'torque'
  | 'density'
  | 'densest'
  | 'rate'
  | 'age'
  | 'bytes';

export interface ChartPlan {
  title: string;
  /** The explanation for newcomers. */
  explanation: string;
  series: readonly { name: SeriesName; label: string; colour: string }[];
  format(value: number): string;
  /** Whether the chart is hidden while it has no values. */
  isSpecial?: boolean;
}

export const kCharts: readonly ChartPlan[] = [
  {
    title: 'Energy',
    explanation:
      'Energy of all bodies, by kind of energy. Gravitational energy is zero at the origin.',
    series: [
      { name: 'kinetic', label: 'motion', colour: '#3f87d9' },
      { name: 'gravitational', label: 'gravity', colour: '#e08a3c' },
      { name: 'elastic', label: 'springs', colour: '#3aa876' },
      { name: 'contact', label: 'contacts', colour: '#d4577a' },
    ],
    format: (value) => `${formatQuantity(value)} J`,
  },
  {
    title: 'Momentum',
    explanation: 'Magnitude of the sum over all bodies.',
    series: [{ name: 'momentum', label: 'momentum', colour: '#a86cc9' }],
    format: (value) => `${formatQuantity(value)} kg m/s`,
  },
  {
    title: 'Torque on axles',
    explanation: 'Sum of the torques of liquids, walls and other bodies, without brakes.',
    series: [{ name: 'torque', label: 'torque', colour: '#c9a13c' }],
    format: (value) => `${formatQuantity(value)} N m`,
    isSpecial: true,
  },
  {
    title: 'Density error of liquids',
    explanation: 'Mean and maximum relative excess over the rest density.',
    series: [
      { name: 'density', label: 'mean', colour: '#3f87d9' },
      { name: 'densest', label: 'most', colour: '#d4577a' },
    ],
    format: (value) => `${formatQuantity(100 * value)} %`,
  },
  {
    title: 'Simulated seconds per second',
    explanation: 'Equals the set speed, unless the server is too slow.',
    series: [{ name: 'rate', label: 'rate', colour: '#3f87d9' }],
    format: formatFactor,
  },
  {
    title: 'Age of the frame',
    explanation: 'Time from the publication of a state to its display.',
    series: [{ name: 'age', label: 'age', colour: '#d4577a' }],
    format: formatMilliseconds,
  },
  {
    title: 'Received per second',
    explanation: 'Bytes of frames.',
    series: [{ name: 'bytes', label: 'bytes', colour: '#3aa876' }],
    format: (value) => `${formatBytes(value)}/s`,
  },
];

export const kSeries: readonly SeriesName[] = kCharts.flatMap(({ series }) =>
  series.map(({ name }) => name),
);

/** Converts the server's diagnostics to series. */
export function diagnosticSeries({
  kinetic_energy: kinetic,
  gravitational_energy: gravitational,
  elastic_energy: elastic,
  contact_energy: contact,
  momentum,
  axle_torque: torque,
  mean_density_error: density,
  max_density_error: densest,
}: Diagnostics): Partial<Record<SeriesName, number>> {
  return {
    kinetic,
    gravitational,
    elastic,
    contact,
    momentum: Math.hypot(...momentum),
    ...(torque !== undefined && { torque }),
    density,
    densest,
  };
}
