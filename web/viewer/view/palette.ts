import { Color } from 'three';
import type { BodyKindName } from '../../client/index';

/** Liquids blue, deformables green as in the paper's figures, rigid bodies in warm colours. */
const kColours: Readonly<Record<BodyKindName, readonly string[]>> = {
  liquid: ['#2f86e0', '#2aa5c9', '#5a78e6'],
  deformable: ['#55b04a', '#8cc63f', '#2f9e77', '#b2cc3a'],
  rigid: ['#e2553d', '#f0a030', '#c8567f', '#d9793a', '#e8c24a', '#a9573c', '#d84a5f', '#b98350'],
};

/** The colour of the n-th body of its kind. */
export function bodyColour(kind: BodyKindName, n: number): Color {
  const colours = kColours[kind];
  return new Color(colours[n % colours.length]);
}

/** Colours of the surroundings; the page's style sheet has the same stage colour. */
export interface Theme {
  stage: Color;
  floor: Color;
  shadow: Color;
  grid: Color;
  edge: Color;
  wall: Color;
}

const kLight: Theme = {
  stage: new Color('#e9edf1'),
  floor: new Color('#fafbfc'),
  shadow: new Color('#aab4bf'),
  grid: new Color('#c3ccd5'),
  edge: new Color('#4a5a6a'),
  wall: new Color('#7f97ad'),
};

const kDark: Theme = {
  stage: new Color('#14181d'),
  floor: new Color('#2a323b'),
  shadow: new Color('#11151a'),
  grid: new Color('#303a45'),
  edge: new Color('#a9b8c6'),
  wall: new Color('#8fa9c2'),
};

export function theme(dark: boolean): Theme {
  return dark ? kDark : kLight;
}
