/** Particles sorted by the cells of a grid: protocol/FRAMES.md, "Order". Reuses its memory. */
export class CellOrder {
  /** Particle indices, cell by cell. */
  order = new Int32Array(0);
  /** For each occupied cell, from number 1: its first index in `order`, and its place. */
  begins = new Int32Array(1);
  places = new Int32Array(1);
  /** By place: the number of the cell, 0 if it is empty. */
  numbers = new Int32Array(0);
  cellCount = 0;
  row = 0;
  layer = 0;
  private placeOf = new Int32Array(0);

  /** Returns false if the box of all cells is too large for the number of particles. */
  sort(positions: Uint16Array, count: number, shift: number): boolean {
    this.cellCount = 0;
    this.reserve(count);
    if (count === 0) return true;
    const [x0, y0, z0, nx, ny, nz] = boxOf(positions, count, shift);
    const placeCount = nx * ny * nz;
    if (placeCount > 4096 + 16 * count) return false;
    this.row = nx;
    this.layer = nx * ny;
    if (this.numbers.length < placeCount) this.numbers = new Int32Array(2 * placeCount);
    else this.numbers.fill(0, 0, placeCount);
    const first = (1 - z0) * this.layer + (1 - y0) * nx + 1 - x0;
    this.countByPlace(positions, count, shift, first);
    this.listCells(placeCount, count);
    this.fillCells(count);
    return true;
  }

  /** `first` is the place of the cell 0, 0, 0. */
  private countByPlace(positions: Uint16Array, count: number, shift: number, first: number): void {
    const { numbers, placeOf, row, layer } = this;
    for (let i = 0, k = 0; i < count; ++i, k += 3) {
      const x = positions[k]! >> shift;
      const y = positions[k + 1]! >> shift;
      const z = positions[k + 2]! >> shift;
      const place = (first + x + Math.imul(y, row) + Math.imul(z, layer)) | 0;
      placeOf[i] = place;
      numbers[place] = (numbers[place]! + 1) | 0;
    }
  }

  /** Sets begins[c + 1] to the first index of cell c. Filling moves it to the end of the cell. */
  private listCells(placeCount: number, count: number): void {
    const { numbers, begins, places } = this;
    let begin = 0;
    let cell = 0;
    begins[1] = 0;
    for (let place = 0; place < placeCount; ++place) {
      const particles = numbers[place]!;
      if (particles === 0) continue;
      cell = (cell + 1) | 0;
      numbers[place] = cell;
      places[cell] = place;
      begins[cell + 1] = begin;
      begin = (begin + particles) | 0;
    }
    this.cellCount = cell;
    if (begin !== count) throw new Error('particles are missing');
  }

  private fillCells(count: number): void {
    const { numbers, placeOf, order, begins: ends } = this;
    for (let i = 0; i < count; ++i) {
      const cell = (numbers[placeOf[i]!]! + 1) | 0;
      const at = ends[cell]!;
      order[at] = i;
      ends[cell] = at + 1;
    }
  }

  private reserve(count: number): void {
    if (this.order.length >= count) return;
    const room = Math.ceil(1.5 * count);
    this.order = new Int32Array(room);
    this.placeOf = new Int32Array(room);
    this.begins = new Int32Array(room + 2);
    this.places = new Int32Array(room + 2);
  }
}

type Box = [number, number, number, number, number, number];

/** Returns the smallest cell, and the cells per axis including an empty layer around them. */
function boxOf(positions: Uint16Array, count: number, shift: number): Box {
  let x0 = 65535;
  let y0 = 65535;
  let z0 = 65535;
  let x1 = 0;
  let y1 = 0;
  let z1 = 0;
  for (let k = 0; k < 3 * count; k += 3) {
    const x = positions[k] as number;
    const y = positions[k + 1] as number;
    const z = positions[k + 2] as number;
    if (x < x0) x0 = x;
    if (x > x1) x1 = x;
    if (y < y0) y0 = y;
    if (y > y1) y1 = y;
    if (z < z0) z0 = z;
    if (z > z1) z1 = z;
  }
  const size = (low: number, high: number) => (high >> shift) - (low >> shift) + 3;
  return [x0 >> shift, y0 >> shift, z0 >> shift, size(x0, x1), size(y0, y1), size(z0, z1)];
}
