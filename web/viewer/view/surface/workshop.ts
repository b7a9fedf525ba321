import type { Surface } from './marching_cubes';

/** Particles to make a surface around; `radius` is in the units of the places. */
export interface SurfaceJob {
  key: number;
  places: Uint16Array | Float32Array;
  radius: number;
  values: Float32Array | undefined;
  /** Over the radius: how far off single particles the surface is. */
  size: number;
}

/** Has surfaces made on another thread, which starts with the first one. */
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
