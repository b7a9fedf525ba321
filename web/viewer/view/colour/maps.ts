import { ClampToEdgeWrapping, Color, DataTexture, LinearFilter, SRGBColorSpace } from 'three';
import type { Choice } from '../base/settings';

type MapName = Choice<'map'>;

/**
 * Colours at equal steps, from the smallest to the largest value. viridis: S. van der Walt and
 * N. Smith (2015, CC0), every sixteenth colour of its table. cividis: J. Nuñez, C. Anderton and
 * R. Renslow, PLoS ONE 13 (2018) e0199239. turbo: A. Mikhailov (Google, 2019, Apache 2.0). Both use
 * the polynomials of d3-scale-chromatic. blue-red: RdBu of C. Brewer's ColorBrewer 2, reversed.
 */
const kStops: Readonly<Record<MapName, string>> = {
  viridis:
    '440154 48186a 472d7b 424086 3b528b 33638d 2c728e 26828e 21918c 1fa088 28ae80 3fbc73 5ec962 84d44b addc30 d8e219 fde725',
  cividis:
    '002051 012b65 11366c 26426e 3c4d6e 51586e 62646f 727071 7f7c75 8c8877 9a9478 a9a177 bbaf71 cebd68 e2cb5c f3da4f fdea45',
  turbo:
    '23171b 493eae 4569ee 3295f7 26bce1 29dcbc 3ff393 65fd6e 95fb51 c5ec3c ecd12e ffad24 ff821d f05616 cb2f0d a31302 900c00',
  'blue-red': '053061 2166ac 4393c3 92c5de d1e5f0 f7f7f7 fddbc7 f4a582 d6604d b2182b 67001f',
};

const kTextureWidth = 256;

/** Returns the map's CSS colours at equal steps, from the smallest to the largest value. */
export function mapStops(name: MapName): string[] {
  return kStops[name].split(' ').map((stop) => `#${stop}`);
}

/** Returns whether the map is diverging: its centre represents a reference value. */
export function isDiverging(name: MapName): boolean {
  return name === 'blue-red';
}

/** Returns red, green and blue (0 to 255) of the map at `at` (0 to 1). */
export function mapColour(name: MapName, at: number): [number, number, number] {
  const stops = mapStops(name).map((stop) => parseInt(stop.slice(1), 16));
  const place = Math.min(Math.max(at, 0), 1) * (stops.length - 1);
  const low = Math.min(Math.floor(place), stops.length - 2);
  const mix = (shift: number): number => {
    const [a, b] = [stops[low]!, stops[low + 1]!].map((stop) => (stop >> shift) & 255);
    return Math.round(a! + (place - low) * (b! - a!));
  };
  return [mix(16), mix(8), mix(0)];
}

/** Returns the map as a texture of one row. */
export function mapTexture(): DataTexture {
  const texture = new DataTexture(new Uint8Array(4 * kTextureWidth), kTextureWidth, 1);
  texture.colorSpace = SRGBColorSpace;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  return texture;
}

export function fillMapTexture(texture: DataTexture, name: MapName): void {
  const data = texture.image.data as Uint8Array;
  for (let i = 0; i < kTextureWidth; ++i) {
    data.set([...mapColour(name, i / (kTextureWidth - 1)), 255], 4 * i);
  }
  texture.needsUpdate = true;
}

/** The colour of particles without a value. */
export const kNoValue = new Color('#8c959e');
