import { Group, Mesh, MeshBasicMaterial, SphereGeometry } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { kLayers } from '../base/layers';

/** Colours of the axes x, y and z. */
const kRed = [0.9, 0.12, 0.12];
const kGreen = [0.1, 0.62, 0.16];
const kBlue = [0.12, 0.3, 0.95];

/** The centre of mass and the axes of a rigid body, drawn over the scene in body axes. */
export class Axes {
  readonly group = new Group();
  private readonly lines: LineSegments2;
  private readonly dot: Mesh<SphereGeometry, MeshBasicMaterial>;

  /** `size` is the length of the axes [m]. */
  constructor(size: number) {
    const geometry = new LineSegmentsGeometry();
    geometry.setPositions([0, 0, 0, size, 0, 0, 0, 0, 0, 0, size, 0, 0, 0, 0, 0, 0, size]);
    geometry.setColors([kRed, kRed, kGreen, kGreen, kBlue, kBlue].flat());
    const over = { depthTest: false, transparent: true };
    const material = new LineMaterial({ linewidth: 3, vertexColors: true, ...over });
    this.lines = new LineSegments2(geometry, material);
    this.dot = new Mesh(
      new SphereGeometry(0.05 * size, 16, 12),
      new MeshBasicMaterial({ color: '#ffffff', ...over }),
    );
    this.lines.renderOrder = 8;
    this.dot.renderOrder = 9;
    this.group.add(this.lines, this.dot);
    this.group.visible = false;
    this.group.traverse(({ layers }) => layers.set(kLayers.marks));
  }

  dispose(): void {
    this.lines.geometry.dispose();
    this.lines.material.dispose();
    this.dot.geometry.dispose();
    this.dot.material.dispose();
  }
}
