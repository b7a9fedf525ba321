import type { Surface } from './marching_cubes';

/** Particles for a surface. `radius` has the units of the positions. */
export interface SurfaceJob {
  key: number;
  places: Uint16Array | Float32Array;
  radius: number;
  values: Float32Array | undefined;
  /** Distance of the surface from a single particle / radius. */
  size: number;
}

/** Computes surfaces in a worker, which starts at the first request. */
export class Workshop {
  private worker: Worker | undefined;
  private readonly waiting = new Map<number, (surface: Surface) => void>();
  private lastKey = 0;

  make(job: Omit<SurfaceJob, 'key'>): Promise<Surface> {
    this.worker ??= this.start();
    const key = ++this.lastKey;
    this.worker.postMessage({ key, ...job });
    return new Promise((resolve) => this.waiting.set(key, resolve));
  }

  private start(): Worker {
    const worker = new Worker(new URL('./surface.worker.ts', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data }: MessageEvent<{ key: number; surface: Surface }>) => {
      this.waiting.get(data.key)?.(data.surface);
      this.waiting.delete(data.key);
    };
    return worker;
  }
}
