import type { Graphics } from './graphics';
import type { Choice } from './settings';

/** The maximum number of particles of a meshed surface; more would take seconds. */
const kMostInSurface = 20_000;

/** The styles of liquids. */
export type LiquidStyle = Exclude<Choice<'liquid'>, 'auto'>;

/** The drawn style. If it is not the best or chosen one, the reason as text. */
export interface StyleDecision {
  style: LiquidStyle;
  words: string | undefined;
}

/**
 * Returns the chosen style if the graphics support it, otherwise the best supported style. `isSlow`:
 * the fluid style was too slow.
 */
export function decideStyle(
  chosen: Choice<'liquid'>,
  graphics: Graphics,
  isSlow: boolean,
  particles: number,
): StyleDecision {
  const wantsFluid = chosen === 'auto' || chosen === 'fluid';
  if (wantsFluid && !graphics.drawsToFloats) {
    return { style: 'splats', words: 'Splats: the graphics hardware cannot draw a clear liquid.' };
  }
  if (chosen === 'fluid' && graphics.isSoftware) {
    return { style: 'fluid', words: 'Slow: the browser draws without a graphics card.' };
  }
  if (chosen === 'surface' && particles > kMostInSurface) {
    const words = `Splats: surfaces are limited to ${kMostInSurface} particles.`;
    return { style: 'splats', words };
  }
  if (chosen !== 'auto') return { style: chosen, words: undefined };
  if (graphics.isSoftware) {
    return { style: 'splats', words: 'Splats: the browser draws without a graphics card.' };
  }
  if (isSlow) {
    return {
      style: 'splats',
      words: 'Splats: the graphics hardware is too slow for a clear liquid.',
    };
  }
  return { style: 'fluid', words: undefined };
}
