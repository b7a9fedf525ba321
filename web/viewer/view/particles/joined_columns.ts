import { BufferGeometry } from 'three';
import { kSquareVertices } from './impostor';
import type { CopiedColumns, ParticleColumns } from './particle_columns';
import { Texels, particleUniforms } from './texels';

const kGrowth = 1.5;

/** The particles of a liquid or deformable body. */
export interface GridBody {
  /** The number of the body. */
  body: number;
  /** The row in the table of bodies, from 0 on. */
  row: number;
  columns: ParticleColumns;
}

/** The textures of several bodies. */
interface JoinedTexels extends CopiedColumns {
  /** See Froth. */
  froth: Texels<Uint8Array>;
  /** See SurfaceShapes. */
  shapes: Texels<Uint32Array>;
}

/** The graphics columns of several bodies, one after the other, for one draw call. */
export class JoinedColumns {
  /** One square per particle. */
  readonly geometry = new BufferGeometry();
  readonly uniforms = particleUniforms();
  columns!: JoinedTexels;
  private known = '';
  private knownNames = '';

  constructor() {
    this.geometry.setDrawRange(0, 0);
    this.show(texelsFor(0));
  }

  /** Copies the columns of these bodies if they have changed. Returns whether they have. */
  update(bodies: readonly GridBody[]): boolean {
    const key = bodies.map(({ body, row, columns }) => `${body} ${row} ${columns.version}`).join();
    if (key === this.known) return false;
    this.known = key;
    const count = bodies.reduce((sum, { columns }) => sum + columns.count, 0);
    if (count > this.columns.center.room) this.reserve(count);
    let at = 0;
    for (const { columns } of bodies) {
      columns.copyTo(this.columns, at);
      at += columns.count;
    }
    this.updateNames(bodies);
    this.geometry.setDrawRange(0, kSquareVertices * count);
    return true;
  }

  private updateNames(bodies: readonly GridBody[]): void {
    const key = bodies
      .map(({ body, row, columns }) => `${body} ${row} ${columns.versionOfNames}`)
      .join();
    if (key === this.knownNames) return;
    this.knownNames = key;
    let at = 0;
    for (const { row, columns } of bodies) {
      columns.copyNamesTo(this.columns.names, at, row + 1);
      at += columns.count;
    }
  }

  private reserve(count: number): void {
    for (const texels of Object.values(this.columns) as { dispose(): void }[]) texels.dispose();
    this.show(texelsFor(Math.ceil(kGrowth * count)));
    this.knownNames = '';
  }

  private show(columns: JoinedTexels): void {
    const { uniforms } = this;
    this.columns = columns;
    uniforms.center_texels.value = columns.center.texture;
    uniforms.before_texels.value = columns.before.texture;
    uniforms.name_texels.value = columns.names.texture;
    uniforms.value_texels.value = columns.shown.texture;
    uniforms.froth_texels.value = columns.froth.texture;
    uniforms.shape_texels.value = columns.shapes.texture;
  }
}

function texelsFor(count: number): JoinedTexels {
  return {
    center: Texels.places(count),
    before: Texels.places(count),
    names: Texels.names(count),
    shown: Texels.shown(count),
    froth: Texels.froth(count),
    shapes: Texels.shapes(count),
  };
}
