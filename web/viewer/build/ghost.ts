import {
  BoxGeometry,
  BufferGeometry,
  Color,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  Vector3,
} from 'three';
import type { Footprint } from '../view/base/footprint';
import { kLayers } from '../view/base/layers';
import type { BodyChoice } from './body_choice';

const kGood = new Color('#2f86e0');
const kBad = new Color('#d63a3a');

/** The object that is placed. `body` is the id of an existing body that is moved. */
export interface Thing extends Pick<BodyChoice, 'shape' | 'mesh'> {
  footprint: Footprint;
  body?: number;
}

/** The preview of the placed object, drawn over the scene: blue if its position is free, else red. */
export class Ghost {
  readonly group = new Group();
  private readonly material = new MeshBasicMaterial({
    transparent: true,
    opacity: 0.45,
    depthTest: false,
  });
  /** Offset of the centre of its box. */
  private readonly offset = new Vector3();
  private readonly mesh = new Mesh<BufferGeometry, MeshBasicMaterial>(
    new BufferGeometry(),
    this.material,
  );

  constructor() {
    this.group.add(this.mesh);
    this.group.visible = false;
    this.mesh.renderOrder = 9;
    this.mesh.layers.set(kLayers.marks);
  }

  show(thing: Thing): void {
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometryOf(thing);
    thing.footprint.box.getSize(this.mesh.scale);
    this.offset.copy(thing.footprint.box.getCenter(new Vector3()));
    this.group.visible = true;
  }

  moveTo(place: Vector3, isFree: boolean): void {
    this.mesh.position.copy(place).add(this.offset);
    this.material.color.copy(isFree ? kGood : kBad);
  }

  hide(): void {
    this.group.visible = false;
  }
}

/** Returns the geometry with a longest side of 1. */
function geometryOf({ shape, mesh }: Thing): BufferGeometry {
  if (shape === 'sphere') return new SphereGeometry(0.5, 32, 20);
  if (shape === 'box' || !mesh) return new BoxGeometry(1, 1, 1);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(mesh.vertices.flat(), 3));
  geometry.setIndex(mesh.triangles.flat());
  return geometry;
}
