import { Group, Mesh, MeshBasicMaterial, SphereGeometry } from 'three';
import type { Vector3 } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { kLayers } from './base/layers';

const kColour = '#ffb300';

/** Shows the held particle, its target, and the line between them, drawn over the scene. */
export class HeldMarker {
  readonly group = new Group();
  private readonly held = marker(0.55);
  private readonly target = marker(0.9);
  private readonly line = new LineSegments2(
    new LineSegmentsGeometry(),
    new LineMaterial({ color: kColour, linewidth: 2.5, depthTest: false, transparent: true }),
  );

  constructor() {
    this.line.renderOrder = 10;
    this.line.frustumCulled = false;
    this.group.add(this.held, this.target, this.line);
    this.group.visible = false;
    this.group.traverse(({ layers }) => layers.set(kLayers.marks));
  }

  show(held: Vector3, target: Vector3, radius: number): void {
    this.held.position.copy(held);
    this.held.scale.setScalar(1.25 * radius);
    this.target.position.copy(target);
    this.target.scale.setScalar(0.4 * radius);
    this.line.geometry.setPositions([...held, ...target]);
    this.group.visible = true;
  }

  hide(): void {
    this.group.visible = false;
  }
}

function marker(opacity: number): Mesh {
  const material = new MeshBasicMaterial({
    color: kColour,
    transparent: true,
    opacity,
    depthTest: false,
  });
  const mesh = new Mesh(new SphereGeometry(1, 24, 16), material);
  mesh.renderOrder = 10;
  return mesh;
}
