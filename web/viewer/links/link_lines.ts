import { Color } from 'three';
import type { Scene, Vector3 } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { kLayers } from '../view/base/layers';

/** Pairs of particles as a flat list, and one value per pair. */
export interface Linked {
  pairs: readonly number[];
  values: readonly number[];
}

/** Returns the drawn position of a particle; undefined if it is not drawn. */
export type PlaceOf = (body: number, particle: number) => Vector3 | undefined;

const kCold = new Color('#1c5fd4');
const kEven = new Color('#8f99a5');
const kWarm = new Color('#d92f2f');

/** Returns blue for negative, red for positive values, grey at zero. `most` has the full colour. */
export function colourOf(value: number, most: number): Color {
  const share = most > 0 ? Math.min(Math.abs(value) / most, 1) : 0;
  return kEven.clone().lerp(value < 0 ? kCold : kWarm, Math.sqrt(share));
}

/** Lines between particles, coloured by a value, drawn over the scene. */
export class LinkLines {
  private readonly material: LineMaterial;
  private lines: LineSegments2 | undefined;

  /** `width` [px]. */
  constructor(
    private readonly scene: Scene,
    width: number,
  ) {
    this.material = new LineMaterial({
      linewidth: width,
      vertexColors: true,
      depthTest: false,
      transparent: true,
    });
  }

  /** Draws the lines at the present positions, and returns their number. */
  show({ pairs, values }: Linked, placeOf: PlaceOf, most: number): number {
    const places: number[] = [];
    const colours: number[] = [];
    values.forEach((value, n) => {
      const a = placeOf(pairs[4 * n]!, pairs[4 * n + 1]!);
      const b = placeOf(pairs[4 * n + 2]!, pairs[4 * n + 3]!);
      if (!a || !b) return;
      places.push(...a, ...b);
      const colour = colourOf(value, most);
      colours.push(...colour, ...colour);
    });
    this.clear();
    if (places.length === 0) return 0;
    const geometry = new LineSegmentsGeometry();
    geometry.setPositions(places);
    geometry.setColors(colours);
    this.lines = new LineSegments2(geometry, this.material);
    this.lines.frustumCulled = false;
    this.lines.renderOrder = 7;
    this.lines.layers.set(kLayers.marks);
    this.scene.add(this.lines);
    return places.length / 6;
  }

  clear(): void {
    this.lines?.removeFromParent();
    this.lines?.geometry.dispose();
    this.lines = undefined;
  }
}
