import { BufferAttribute, BufferGeometry, Mesh } from 'three';
import type { ShaderMaterial } from 'three';
import type { BodyUniforms } from '../particles/impostor';
import type { Surface } from './marching_cubes';
import { skinMaterial } from './skin_material';
import type { SurfaceJob, Workshop } from './workshop';

type Job = Omit<SurfaceJob, 'key'>;

/** A smooth surface around a body's particles, updated as fast as it can be computed. */
export class Skin {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private isBusy = false;
  private next: Job | undefined;
  private isGone = false;

  /** `onMade` is called after each new surface. */
  constructor(
    private readonly workshop: Workshop,
    uniforms: BodyUniforms,
    private readonly onMade: () => void,
  ) {
    this.mesh = new Mesh(new BufferGeometry(), skinMaterial(uniforms));
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  set opacity(opacity: number) {
    this.mesh.material.uniforms.opacity!.value = opacity;
  }

  /** Requests a surface for moved particles. During a computation, only the newest request is stored. */
  follow(job: Job): void {
    this.next = job;
    if (!this.isBusy) void this.work();
  }

  dispose(): void {
    this.isGone = true;
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private async work(): Promise<void> {
    this.isBusy = true;
    while (this.next && !this.isGone) {
      const job = this.next;
      this.next = undefined;
      const surface = await this.workshop.make(job);
      if (!this.isGone) this.show(surface);
    }
    this.isBusy = false;
  }

  private show({ positions, normals, values, indices }: Surface): void {
    const geometry = new BufferGeometry();
    const amounts = values ?? new Float32Array(positions.length / 3);
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(normals, 3));
    geometry.setAttribute('amount', new BufferAttribute(amounts, 1));
    geometry.setIndex(new BufferAttribute(indices, 1));
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometry;
    this.onMade();
  }
}
