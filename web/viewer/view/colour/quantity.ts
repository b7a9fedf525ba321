import type { Attributes } from '../../../client/index';
import type { Choice } from '../base/settings';

/** The quantities that colours can show. */
export type QuantityName = Exclude<Choice<'colour'>, 'material' | 'body' | 'kind' | 'normals'>;

export interface Quantity {
  title: string;
  unit: string;
  /** Index of the attribute in frames. */
  column: number;
}

export const kQuantities: Readonly<Record<QuantityName, Quantity>> = {
  speed: { title: 'Speed', unit: 'm/s', column: 0 },
  density: { title: 'Density', unit: 'kg/m³', column: 1 },
  pressure: { title: 'Pressure', unit: 'Pa', column: 2 },
  force: { title: 'Force per mass', unit: 'm/s²', column: 3 },
};

/** Returns the attribute of the protocol. */
export function attributeOf(name: QuantityName): keyof Attributes {
  return name === 'force' ? 'acceleration' : name;
}

export function quantityOf(colour: Choice<'colour'>): QuantityName | undefined {
  return colour in kQuantities ? (colour as QuantityName) : undefined;
}

/** Typical gravity [m/s²] and density [kg/m³], for the resolution of attributes. */
const kGravity = 9.81;
const kDensity = 1000;

/** The number of distinguishable steps between zero and the typical maximum. */
const kSteps = 200;

/** Returns the required error of a quantity, for the resolution of colours and a scene height [m]. */
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

/** Formats a number with three significant digits. */
export function formatQuantity(value: number): string {
  if (value === 0) return '0';
  const power = Math.floor(Math.log10(Math.abs(value)));
  if (power >= 5 || power < -3) return value.toExponential(1).replace('e+', 'e');
  return value.toFixed(Math.max(0, 2 - power)).replace('-', '−');
}
