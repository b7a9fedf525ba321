import { BackSide, Box3, BoxGeometry, EdgesGeometry, Group, Mesh, MeshBasicMaterial } from 'three';
import { PlaneGeometry, Vector3 } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Vector, VatDescription } from '../../client/index';
import type { Theme } from './base/theme';

/** The vat: edges, a floor, and slightly tinted far walls. */
export class VatView {
  readonly group = new Group();
  private readonly low: Vector3;
  private readonly high: Vector3;
  private readonly edges: LineSegments2;
  private readonly floor: Mesh<PlaneGeometry, MeshBasicMaterial>;
  private readonly walls: Mesh<BoxGeometry, MeshBasicMaterial>;

  constructor({ min, max }: VatDescription, look: Theme) {
    const low = (this.low = new Vector3(...min));
    this.high = new Vector3(...max);
    const size = new Vector3(...max).sub(low);
    const middle = size.clone().multiplyScalar(0.5).add(low);

    const box = new BoxGeometry(size.x, size.y, size.z);
    this.edges = new LineSegments2(
      new LineSegmentsGeometry().fromEdgesGeometry(new EdgesGeometry(box)),
      new LineMaterial({ linewidth: 1.5 }),
    );
    this.edges.position.copy(middle);
    this.edges.renderOrder = 2;

    this.walls = new Mesh(box, new MeshBasicMaterial({ side: BackSide }));
    this.walls.material.transparent = true;
    this.walls.material.opacity = 0.1;
    this.walls.material.depthWrite = false;
    this.walls.position.copy(middle);

    this.floor = new Mesh(new PlaneGeometry(size.x, size.y), new MeshBasicMaterial());
    this.floor.position.set(middle.x, middle.y, low.z);
    this.floor.material.depthWrite = false; // drawn spheres can overlap the floor

    this.group.add(this.floor, this.walls, this.edges);
    this.paint(look);
  }

  paint(look: Theme): void {
    this.edges.material.color.copy(look.edge);
    this.walls.material.color.copy(look.wall);
    this.floor.material.color.copy(look.floor);
  }

  /** Moves the vat to a displacement from its position at time 0. */
  moveTo(offset: Vector): void {
    this.group.position.set(...offset);
  }

  /** The present box. */
  get box(): Box3 {
    const { position } = this.group;
    return new Box3(this.low.clone().add(position), this.high.clone().add(position));
  }

  /** Extends the box to contain the vat at its present position. */
  expand(box: Box3): void {
    box.union(this.box);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.edges.geometry.dispose();
    this.edges.material.dispose();
    this.walls.geometry.dispose();
    this.walls.material.dispose();
    this.floor.geometry.dispose();
    this.floor.material.dispose();
  }
}

/** Returns the lengths of the sides [m]. */
export function sizeOf({ min, max }: VatDescription): number[] {
  return max.map((most, q) => most - min[q]!);
}
