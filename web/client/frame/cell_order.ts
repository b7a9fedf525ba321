/** Particles by the cells of a grid: protocol/PROTOCOL.md, "Order". Keeps its memory. */
export class CellOrder {
  /** Particles, cell by cell. */
  order = new Uint32Array(0);
  /** Of the cells with particles, from number 1 on: their particles in `order`, and their places. */
  begins = new Uint32Array(1);
  places = new Uint32Array(1);
  /** By place: the number of the cell there, 0 where it is empty. */
  numbers = new Uint32Array(0);
  cellCount = 0;
  row = 0;
  layer = 0;
  private placeOf = new Uint32Array(0);

  /** False where the box of all cells would be too large for so few particles. */
  sort(positions: Uint16Array, count: number, shift: number): boolean {
    this.cellCount = 0;
    this.reserve(count);
    if (count === 0) return true;
    const box = boxOf(positions, count, shift);
    const [x0, y0, z0, nx, ny, nz] = box;
    const placeCount = nx * ny * nz;
    if (placeCount > 4096 + 16 * count) return false;
    this.row = nx;
    this.layer = nx * ny;
    if (this.numbers.length < placeCount) this.numbers = new Uint32Array(2 * placeCount);
    else this.numbers.fill(0, 0, placeCount);
    const { numbers, placeOf, order } = this;
    for (let i = 0, k = 0; i < count; ++i, k += 3) {
      const x = ((positions[k] as number) >> shift) - x0 + 1;
      const y = ((positions[k + 1] as number) >> shift) - y0 + 1;
      const z = ((positions[k + 2] as number) >> shift) - z0 + 1;
      const place = z * this.layer + y * nx + x;
      placeOf[i] = place;
      numbers[place] = (numbers[place] as number) + 1;
    }
    this.listCells(placeCount, count);
    const ends = this.begins;
    for (let i = 0; i < count; ++i) {
      const cell = numbers[placeOf[i] as number] as number;
      const at = ends[cell + 1] as number;
      order[at] = i;
      ends[cell + 1] = at + 1;
    }
    return true;
  }

  /** Leaves begins[c + 1] at the begin of cell c; filling in moves it to its end. */
  private listCells(placeCount: number, count: number): void {
    const { numbers, begins, places } = this;
    let begin = 0;
    let cell = 0;
    begins[1] = 0;
    for (let place = 0; place < placeCount; ++place) {
      const particles = numbers[place] as number;
      if (particles === 0) continue;
      ++cell;
      numbers[place] = cell;
      places[cell] = place;
      begins[cell + 1] = begin;
      begin += particles;
    }
    this.cellCount = cell;
    if (begin !== count) throw new Error('particles lost');
  }

  private reserve(count: number): void {
    if (this.order.length >= count) return;
    const room = Math.ceil(1.5 * count);
    this.order = new Uint32Array(room);
    this.placeOf = new Uint32Array(room);
    this.begins = new Uint32Array(room + 2);
    this.places = new Uint32Array(room + 2);
  }
}

type Box = [number, number, number, number, number, number];

/** The least cell, and how many there are along each axis with an empty layer around. */
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
