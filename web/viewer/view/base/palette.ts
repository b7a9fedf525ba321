import { Color } from 'three';
import type { BodyKindName } from '../../../client/index';

/** Liquids blue, deformables green as in the paper's figures, rigid bodies in warm colours. */
const kColours: Readonly<Record<BodyKindName, readonly string[]>> = {
  liquid: ['#2f86e0', '#2aa5c9', '#5a78e6'],
  deformable: ['#55b04a', '#8cc63f', '#2f9e77', '#b2cc3a'],
  rigid: ['#e2553d', '#f0a030', '#c8567f', '#d9793a', '#e8c24a', '#a9573c', '#d84a5f', '#b98350'],
};

/** Returns the colour of the n-th body of a kind. */
export function bodyColour(kind: BodyKindName, n: number): Color {
  const colours = kColours[kind];
  return new Color(colours[n % colours.length]);
}
