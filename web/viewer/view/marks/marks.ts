import { Group } from 'three';
import type { Box3, BufferGeometry, Material, Mesh } from 'three';
import type { BodyView } from '../bodies/body_view';
import { roundLength } from '../base/ground';
import type { ViewSettings } from '../base/settings';
import type { Theme } from '../base/theme';
import { arrowMesh, arrowUniforms } from './arrows';
import { Axes } from './axes';
import { Cells } from './cells';

/** The maximum number of arrows; more would hide one another. */
const kMostArrows = 450;

/** Arrow length, relative to the scene's height, of a fall from that height. */
const kArrowLength = 0.18;
const kGravity = 9.81;

/** Support radius / particle radius: two spacings. */
const kSupport = 4;

/** The marks of one body. Rigid bodies have axes. */
interface BodyMarks {
  arrows: Mesh<BufferGeometry, Material>;
  axes: Axes | undefined;
}

/** The marks over bodies: velocities, axes and cells. */
export class Marks {
  readonly group = new Group();
  private readonly uniforms = arrowUniforms();
  private readonly cells = new Cells();
  private readonly marked = new Map<BodyView, BodyMarks>();
  private settings: ViewSettings | undefined;
  private support = 0;

  constructor() {
    this.group.add(this.cells.mesh);
  }

  /** Adds marks to bodies. The marks of removed bodies disappear with their groups. */
  describe(bodies: readonly BodyView[], height: number): void {
    this.forgetAllBut(new Set(bodies));
    const particles = bodies.reduce((sum, { count }) => sum + count, 0);
    this.uniforms.every.value = Math.max(1, Math.ceil(particles / kMostArrows));
    this.uniforms.seconds.value = roundLength(
      (kArrowLength * height) / Math.sqrt(2 * kGravity * height),
    );
    for (const body of bodies) if (!this.marked.has(body)) this.mark(body);
    const radii = bodies.map(({ description }) => description.radius);
    this.support = radii.length > 0 ? kSupport * Math.max(...radii) : 0;
    if (this.settings) this.apply(this.settings);
  }

  apply(settings: ViewSettings): void {
    this.settings = settings;
    for (const { arrows, axes } of this.marked.values()) {
      arrows.visible = settings.arrows;
      if (axes) axes.group.visible = settings.axes;
    }
    this.cells.mesh.visible = settings.cells && this.support > 0;
  }

  /** Updates the extent of the scene. */
  follow(box: Box3): void {
    if (this.support > 0 && !box.isEmpty()) this.cells.fit(box, this.support);
  }

  paint(look: Theme): void {
    this.uniforms.ink.value.copy(look.mark);
    this.cells.paint(look.edge);
  }

  /** The meaning of the marks as text. */
  get words(): string[] {
    const { arrows, cells } = this.settings ?? {};
    const seconds = Number(this.uniforms.seconds.value.toPrecision(1));
    const centimetres = Number((100 * this.support).toPrecision(2));
    return [
      ...(arrows ? [`Arrows show the distance that a particle moves in ${seconds} s.`] : []),
      ...(cells
        ? [`Cells are ${centimetres} cm wide, the interaction distance of particles.`]
        : []),
    ];
  }

  private mark(body: BodyView): void {
    const { description, drawn, columns, group } = body;
    const { radius, local_positions: local } = description;
    const arrows = arrowMesh(columns, drawn, radius, local !== undefined, this.uniforms);
    group.add(arrows);
    const size = local && 1.4 * Math.max(...local.map(Math.abs)) + 2 * radius;
    const axes = size === undefined ? undefined : new Axes(size);
    if (axes) group.add(axes.group);
    this.marked.set(body, { arrows, axes });
  }

  private forgetAllBut(bodies: ReadonlySet<BodyView>): void {
    for (const [body, { arrows, axes }] of this.marked) {
      if (bodies.has(body)) continue;
      arrows.material.dispose();
      axes?.dispose();
      this.marked.delete(body);
    }
  }
}
