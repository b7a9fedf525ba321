import type { Graphics } from './graphics';
import type { Choice } from './settings';

/** A surface around more would be seconds behind them. */
const kMostInSurface = 20_000;

/** How liquids are drawn. */
export type LiquidStyle = Exclude<Choice<'liquid'>, 'auto'>;

/** The style that is drawn and, where it is not the best or the chosen one, why, in words. */
export interface StyleDecision {
  style: LiquidStyle;
  words: string | undefined;
}

/**
 * The best style that the graphics are good for, or the chosen one where that can be drawn at all;
 * `isSlow`: the fluid was tried and took too long.
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
