import { Color } from 'three';
import type { Appearance } from '../../../client/index';

/** The finishes, in the order of their numbers in shaders. */
export const kFinishes = ['none', 'wood', 'brick', 'rubber', 'steel', 'clay'] as const;

/** The complete appearance of a material. */
export interface Look {
  colour: Color;
  /** 0: mirror, 1: matt. */
  roughness: number;
  /** 0: dielectric, 1: metal. */
  metalness: number;
  /** 0: transparent, 1: opaque. */
  opacity: number;
  /** The depth at which white light has the colour [m]; undefined: from the size of the scene. */
  absorptionLength: number | undefined;
  /** The index in kFinishes. */
  finish: number;
}

/** Returns the appearance in a description. Missing members, from older servers, are plain. */
export function lookOf(appearance: Appearance | undefined): Look {
  const {
    colour = '#8f9aa5',
    roughness = 0.5,
    metalness = 0,
    opacity = 1,
    absorption_length: absorptionLength,
    finish = 'none',
  } = appearance ?? {};
  return {
    colour: new Color(colour),
    roughness,
    metalness,
    opacity,
    absorptionLength,
    finish: Math.max(kFinishes.indexOf(finish), 0),
  };
}

/** The transparency of an opaque liquid, in widths of the scene. */
const kLeastTransparency = 0.05;

/** Returns the depth with full colour [m] in a scene of this smallest width [m]. */
export function absorptionLengthOf({ absorptionLength, opacity }: Look, width: number): number {
  return absorptionLength ?? width * (1 + kLeastTransparency - opacity);
}
