import type { Attributes } from '../../../client/index';
import type { Choice } from '../settings';

/** What numbers of particles can be shown by colour. */
export type QuantityName = Exclude<Choice<'colour'>, 'body' | 'kind'>;

export interface Quantity {
  title: string;
  unit: string;
  /** Its column in frames. */
  column: number;
}

export const kQuantities: Readonly<Record<QuantityName, Quantity>> = {
  speed: { title: 'Speed', unit: 'm/s', column: 0 },
  density: { title: 'Density', unit: 'kg/m³', column: 1 },
  pressure: { title: 'Pressure', unit: 'Pa', column: 2 },
  force: { title: 'Force per mass', unit: 'm/s²', column: 3 },
};

/** What frames call it. */
export function attributeOf(name: QuantityName): keyof Attributes {
  return name === 'force' ? 'acceleration' : name;
}

export function quantityOf(colour: Choice<'colour'>): QuantityName | undefined {
  return colour === 'body' || colour === 'kind' ? undefined : colour;
}

/** Gravity [m/s²] and density [kg/m³] that scenes have about; they only say how fine is enough. */
const kGravity = 9.81;
const kDensity = 1000;

/** More steps than this between nothing and the most that a scene of this height has are not seen. */
const kSteps = 200;

/** How exactly frames should have the quantity, in a scene so high [m]: as well as colours tell. */
export function quantityError(name: QuantityName, height: number): number {
  switch (name) {
    case 'speed':
      return Math.sqrt(2 * kGravity * height) / kSteps;
    case 'density':
      return (0.1 * kDensity) / kSteps;
    case 'pressure':
      return (kDensity * kGravity * height) / kSteps;
    case 'force':
      return (5 * kGravity) / kSteps;
  }
}

/** A number with three digits that mean something. */
export function formatQuantity(value: number): string {
  if (value === 0) return '0';
  const power = Math.floor(Math.log10(Math.abs(value)));
  if (power >= 5 || power < -3) return value.toExponential(1).replace('e+', 'e');
  return value.toFixed(Math.max(0, 2 - power)).replace('-', '−');
}
