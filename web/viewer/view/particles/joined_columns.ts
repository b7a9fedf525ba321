import { Float32BufferAttribute, InstancedBufferAttribute, InstancedBufferGeometry } from 'three';
import { kSquare, kSquareTriangles } from './particle_columns';
import type { CopiedColumns, ParticleColumns } from './particle_columns';

const kGrowth = 1.5;

/** The particles of a liquid or deformable body. */
export interface GridBody {
  /** The number of the body. */
  body: number;
  /** The row in the table of bodies, from 0 on. */
  row: number;
  columns: ParticleColumns;
}

/** The graphics columns of several bodies, one after the other, as the instances of one geometry. */
export class JoinedColumns {
  readonly geometry = new InstancedBufferGeometry();
  /** Foam and isolation of each particle; see Froth. */
  froth = new Uint8Array(0);
  columns: CopiedColumns = columnsOf(0);
  private rows = new Float32Array(0);
  private known = '';

  constructor() {
    this.geometry.setAttribute('position', new Float32BufferAttribute(kSquare, 3));
    this.geometry.setIndex([...kSquareTriangles]);
    this.geometry.instanceCount = 0;
  }

  /** Copies the columns of these bodies if they have changed. Returns whether they have. */
  update(bodies: readonly GridBody[]): boolean {
    const key = bodies.map(({ body, row, columns }) => `${body} ${row} ${columns.version}`).join();
    if (key === this.known) return false;
    this.known = key;
    const count = bodies.reduce((sum, { columns }) => sum + columns.count, 0);
    if (count > this.rows.length || !this.geometry.hasAttribute('center')) this.reserve(count);
    let at = 0;
    for (const { row, columns } of bodies) {
      columns.copyTo(this.columns, at);
      this.rows.fill(row + 1, at, at + columns.count);
      at += columns.count;
    }
    this.geometry.instanceCount = count;
    for (const attribute of Object.values(this.geometry.attributes)) attribute.needsUpdate = true;
    return true;
  }

  private reserve(count: number): void {
    const room = Math.ceil(kGrowth * count);
    this.geometry.dispose(); // releases the old buffers
    this.columns = columnsOf(room);
    this.rows = new Float32Array(room);
    this.froth = new Uint8Array(4 * room);
    const { center, before, number, value } = this.columns;
    const attributes = { center, before, number, value, row: this.rows };
    for (const [name, array] of Object.entries(attributes)) {
      const size = array.length / room;
      this.geometry.setAttribute(name, new InstancedBufferAttribute(array, size));
    }
    this.geometry.setAttribute('froth', new InstancedBufferAttribute(this.froth, 4, true));
  }
}

function columnsOf(count: number): CopiedColumns {
  return {
    center: new Uint16Array(3 * count),
    before: new Uint16Array(3 * count),
    number: new Uint32Array(count),
    value: new Int32Array(count),
  };
}
