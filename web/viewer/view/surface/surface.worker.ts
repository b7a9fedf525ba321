/** Computes surfaces around particles in a worker, so that the page's thread only draws. */
import { fieldAround } from './field';
import { marchingCubes } from './marching_cubes';
import type { SurfaceJob } from './workshop';

self.onmessage = ({ data: { key, places, radius, values, size } }: MessageEvent<SurfaceJob>) => {
  const surface = marchingCubes(fieldAround(places, radius, values, size));
  const { positions, normals, indices } = surface;
  const columns = [positions, normals, indices, ...(surface.values ? [surface.values] : [])];
  self.postMessage({ key, surface }, { transfer: columns.map(({ buffer }) => buffer) });
};
