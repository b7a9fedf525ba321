import { Color } from 'three';
import { BodyKind } from '../../web/client/index';
import type { BodyDescription, Frame, SessionDescription } from '../../web/client/index';
import type { Theme } from '../../web/viewer/view/base/theme';

const kNames = ['ground', 'sky', 'stage', 'floor', 'shadow', 'grid', 'edge', 'wall', 'mark'];
export const kTheme = Object.fromEntries(
  kNames.map((name) => [name, new Color()]),
) as unknown as Theme;

/** A session with liquids of one particle, which have these numbers and materials. */
export function described(
  materials: Readonly<Record<number, string>>,
  change: Partial<SessionDescription> = {},
): SessionDescription {
  const bodies = Object.entries(materials).map(([body, material]): BodyDescription => {
    return { body: Number(body), name: body, kind: 'liquid', material, particles: 1, radius: 0.01 };
  });
  return {
    ...{ session: 's1', epoch: 1, tick: 0, name: '', scene: 'pool', title: '', playing: false },
    ...{ speed: 1, tick_seconds: 0.02, gravity: [0, 0, -9.81], materials: [], bodies },
    vat: { min: [0, 0, 0], max: [1, 1, 1], lid: false },
    ...change,
  };
}

/** A frame with one particle per body at this x. */
export function frameOf(epoch: number, places: Readonly<Record<number, number>>): Frame {
  return {
    header: { epoch, time: 0, origin: [0, 0, 0], quantum: 0.1, attributeQuanta: [] },
    blocks: Object.entries(places).map(([body, x]) => ({
      ...{ kind: BodyKind.liquid, body: Number(body), numbers: undefined, attributes: [] },
      positions: Uint16Array.of(x, 0, 0),
    })),
  } as unknown as Frame;
}
