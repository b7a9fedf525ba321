import { Box3, Group, Vector3 } from 'three';
import type { Ray } from 'three';
import { BodyKind } from '../../client/index';
import type {
  BodyDescription,
  BodyKindName,
  Frame,
  FrameHeader,
  GridBlock,
  PoseBlock,
  SessionDescription,
  Vector,
} from '../../client/index';
import { BodyView, isGrid } from './bodies/body_view';
import { kQuantities, quantityOf } from './colour/quantity';
import type { Range } from './colour/range';
import type { FluidLook } from './fluid/fluid_pass';
import { LiquidDrawing } from './fluid/liquid_drawing';
import type { Footprint } from './base/footprint';
import { absorptionLengthOf, lookOf } from './base/appearance';
import type { Look } from './base/appearance';
import { Ground, roundLength } from './base/ground';
import type { Theme } from './base/theme';
import { removeWalls, setWalls } from './fluid/wall_uniforms';
import { Contents } from './contents';
import { Marks } from './marks/marks';
import type { LiquidStyle } from './base/liquid_style';
import type { Choice } from './base/settings';
import type { SharedUniforms } from './bodies/shared_uniforms';
import { BodyTable } from './particles/body_table';
import { JoinedGrids } from './particles/joined_grids';
import { JoinedParticles } from './particles/joined_particles';
import type { JoinedSolids } from './solids/joined_solids';
import type { SolidMaker } from './solids/solid_of';
import { Workshop } from './surface/workshop';
import { sizeOf, VatView } from './vat_view';

/** A particle under the pointer. */
export interface Picked {
  body: number;
  particle: number;
  position: Vector3;
}

/** Position and radius of a particle, and the number of particles of its body. */
export interface Shown {
  position: Vector3;
  radius: number;
  particles: number;
}

/** Size of details of bodies that are not visible, relative to the longest side of the vat. */
const kDetail = 2.5e-4;

/** The contents of a session: bodies, vat and ground. */
export class World {
  readonly group = new Group();
  readonly marks = new Marks();
  private readonly ground: Ground;
  private bodies = new Map<number, BodyView>();
  private vat: VatView | undefined;
  private description: SessionDescription | undefined;
  private looks: ReadonlyMap<string, Look> = new Map();
  /** The union of the vat's positions or, without a vat, the initial extent of the bodies. */
  private seen = new Box3();
  private readonly contents = new Contents();
  private style: LiquidStyle = 'splats';
  private solids: Choice<'solids'> = 'shape';
  private colouring: Choice<'colour'> = 'material';
  private readonly workshop = new Workshop();
  private makeSolid: SolidMaker | undefined;
  /** Rigid bodies that are drawn together. */
  private readonly table: BodyTable;
  private readonly particles: JoinedParticles;
  private joined: JoinedSolids | undefined;
  /** Liquid and deformable bodies that are drawn together. */
  private readonly grids: JoinedGrids;
  private readonly drawing: LiquidDrawing;
  /** The grid of the positions in the last frame. */
  private grid: Pick<FrameHeader, 'origin' | 'quantum'> = { origin: [0, 0, 0], quantum: 1 };
  /** Called after changes between frames. */
  onChange: () => void = () => undefined;
  /** Time of the last frame [s]. */
  private time: number | undefined;
  /** Receives the range of the coloured quantity in each frame. */
  onValues: (range: Range) => void = () => undefined;

  constructor(
    private look: Theme,
    private readonly shared: SharedUniforms,
  ) {
    this.ground = new Ground(look, shared.sun);
    this.table = new BodyTable(shared.look);
    this.particles = new JoinedParticles(shared);
    this.grids = new JoinedGrids(shared);
    this.drawing = new LiquidDrawing(shared);
    this.group.add(this.ground.mesh, this.marks.group, this.particles.group);
    this.group.add(this.grids.group, this.drawing.group);
    this.paint(look);
  }

  /** Draws solids by their shapes from now on, opaque rigid ones together. */
  drawSolids(make: SolidMaker, joined: JoinedSolids): void {
    this.makeSolid = make;
    this.joined = joined;
    this.group.add(joined.group);
    for (const view of this.bodies.values()) view.addSolid(make);
  }

  /** Called before each picture. */
  prepare(): void {
    const shown = [...this.bodies.values()].filter(({ group }) => group.visible);
    this.table.reserve(shown.length);
    shown.forEach((view, row) => {
      const { description, density, bodyLength: length } = view;
      const values = { length, radius: description.radius, density };
      this.table.write(row, view.group.matrix, view.uniforms, values);
    });
    this.table.finish();
    const rows = shown.map((view, row) => ({ view, row }));
    const rigid = rows.filter(({ view }) => view.isRigid);
    this.particles.update(rigid.map(({ view, row }) => ({ row, ...view.particles })));
    this.joined?.update(
      rigid.flatMap(({ view: { joinable: solid }, row }) => (solid ? [{ row, solid }] : [])),
    );
    const grids = rows.filter(({ view }) => !view.isRigid);
    this.grids.update(grids.map(({ view, row }) => ({ row, ...view.gridParticles })));
    const liquids = grids.filter(({ view }) => view.isLiquid);
    this.drawing.update(
      liquids.map(({ view, row }) => ({ row, ...view.gridParticles })),
      () => shown.filter((view) => !view.isLiquid).map((view) => view.solidParticles),
      { ...this.grid, seconds: this.shared.look.interval.value, height: this.height },
    );
  }

  /** Shows a description. Bodies of the same scene remain visible until the next frame. */
  describe(description: SessionDescription): void {
    const { session, scene, vat } = description;
    const before = this.description;
    const isSame =
      session === before?.session &&
      scene === before.scene &&
      JSON.stringify(vat) === JSON.stringify(before.vat);
    if (!isSame) this.clear();
    this.description = description;
    this.looks = new Map(
      description.materials.map(({ name, appearance }) => [name, lookOf(appearance)]),
    );
    this.time = undefined;
    this.shared.detail.value = vat ? kDetail * Math.max(...sizeOf(vat)) : 0;
    const old = this.bodies;
    this.bodies = new Map();
    const counts: Record<BodyKindName, number> = { liquid: 0, deformable: 0, rigid: 0 };
    for (const body of description.bodies) {
      this.bodies.set(body.body, this.viewOf(body, counts[body.kind]++, old.get(body.body)));
    }
    for (const [body, view] of old) if (this.bodies.get(body) !== view) view.dispose();
    if (vat && !this.vat) {
      this.vat = new VatView(vat, this.look);
      this.group.add(this.vat.group);
      this.moveVat([0, 0, 0]);
      this.ground.fit(this.seen);
    }
    this.measureClarity();
    this.marks.describe([...this.bodies.values()], this.height);
  }

  /** Returns the existing view if it can show the body. */
  private viewOf(body: BodyDescription, nth: number, old: BodyView | undefined): BodyView {
    const look = this.lookOf(body);
    const material = this.description!.materials.find(({ name }) => name === body.material);
    if (old?.isOf(body, nth)) {
      old.rest();
      old.look = look;
      old.tearingStrain = material?.tearing_strain;
      return old;
    }
    const view = new BodyView(body, nth, look, this.shared, this.workshop, () => this.onChange());
    view.tearingStrain = material?.tearing_strain;
    view.liquidStyle = this.style;
    view.colour = this.colouring;
    view.solidStyle = this.solids;
    if (this.makeSolid) view.addSolid(this.makeSolid);
    this.group.add(view.group);
    return view;
  }

  /** Shows a frame. Returns false if it belongs to another epoch. */
  show(frame: Frame): boolean {
    if (frame.header.epoch !== this.description?.epoch) return false;
    const seconds = frame.header.time - (this.time ?? frame.header.time);
    this.time = frame.header.time;
    this.shared.look.interval.value = seconds;
    this.grid = frame.header;
    for (const block of frame.blocks) {
      if (block.kind === BodyKind.vat) this.moveVat(block.offset);
      else this.showBlock(block, frame.header, seconds);
    }
    const { vat } = this.description;
    const box = vat ? this.seen : new Box3();
    this.contents.follow([...this.bodies.values()], box, vat?.lid ?? false, seconds);
    if (this.seen.isEmpty()) this.settle();
    this.marks.follow(this.extent);
    this.ground.shade(this.contents.extent);
    return true;
  }

  /** Interpolates between the previous frame (0) and the newest (1). */
  set phase(phase: number) {
    this.shared.look.phase.value = phase;
    for (const view of this.bodies.values()) view.phase = phase;
  }

  /** Sets the coloured quantity, from the next frame on. */
  set colour(colour: Choice<'colour'>) {
    this.colouring = colour;
    for (const view of this.bodies.values()) view.colour = colour;
  }

  private showBlock(block: GridBlock | PoseBlock, header: FrameHeader, seconds: number): void {
    const view = this.bodies.get(block.body);
    if (!view) return;
    if (isGrid(block)) view.showGrid(block, header);
    else view.showPose(block, seconds);
    const name = quantityOf(this.colouring);
    if (!name) return;
    const values = isGrid(block) ? block.attributes[kQuantities[name].column] : undefined;
    this.onValues(view.valueRange(values));
  }

  /** The extent of the scene. It includes all previous positions of a moving vat. */
  get bounds(): Box3 {
    return this.seen;
  }

  /** The box for the camera. */
  get framed(): Box3 {
    return this.contents.framedIn(this.seen);
  }

  pick(ray: Ray): Picked | undefined {
    let nearest: Picked | undefined;
    let distance = Infinity;
    for (const [body, view] of this.bodies) {
      const hit = view.pick(ray);
      const position = hit && view.positionOf(hit.particle);
      if (!position || hit.distance >= distance) continue;
      distance = hit.distance;
      nearest = { body, particle: hit.particle, position };
    }
    return nearest;
  }

  /** Returns a particle; undefined if it or its body was removed. */
  particle(body: number, particle: number): Shown | undefined {
    const view = this.bodies.get(body);
    const position = view?.positionOf(particle);
    const of = view && { radius: view.description.radius, particles: view.count };
    return of && position && { position, ...of };
  }

  /** Returns whether no particle, except those of one body, touches a footprint. */
  isFree(middle: Vector3, footprint: Footprint, except?: number): boolean {
    return [...this.bodies].every(
      ([body, view]) => body === except || view.places.isFree(middle, footprint),
    );
  }

  /** Returns the space of a body, relative to its centre. */
  footprintOf(body: number): Footprint | undefined {
    return this.bodies.get(body)?.places.footprint();
  }

  /** Returns the particle closest to a body's centre. */
  middleOf(body: number): { particle: number; position: Vector3 } | undefined {
    return this.bodies.get(body)?.places.middle();
  }

  /** Returns a body's properties with its present number of particles. */
  describedBody(body: number): BodyDescription | undefined {
    const view = this.bodies.get(body);
    return view && { ...view.description, particles: view.count };
  }

  /** Returns the centre of a body, at the present phase. */
  centreOf(body: number): Vector3 | undefined {
    return this.bodies.get(body)?.places.centre();
  }

  paint(look: Theme): void {
    this.look = look;
    this.ground.paint(look);
    this.vat?.paint(look);
    this.marks.paint(look);
    this.shared.floor.floor_colour.value.copy(look.floor);
    this.shared.floor.shadow_colour.value.copy(look.shadow);
  }

  /** The present extent of the vat, or of the bodies if there is no vat. */
  get extent(): Box3 {
    return this.vat?.box ?? this.seen;
  }

  /** The height of the scene [m]. */
  get height(): number {
    const { min, max } = this.extent;
    return max.z > min.z ? max.z - min.z : 1;
  }

  /** Sets the style of liquids. */
  set liquidStyle(style: LiquidStyle) {
    this.style = style;
    this.drawing.style = style;
    for (const view of this.bodies.values()) view.liquidStyle = style;
  }

  /** Sets the style of deformable and rigid bodies. */
  set solidStyle(style: Choice<'solids'>) {
    this.solids = style;
    for (const view of this.bodies.values()) view.solidStyle = style;
  }

  /** The number of liquid particles. */
  get liquidParticles(): number {
    return this.liquids.reduce((sum, { count }) => sum + count, 0);
  }

  /** The appearance of the scene's liquids; undefined without liquids. */
  get fluid(): FluidLook | undefined {
    const radii = this.liquids.map(({ description }) => description.radius);
    if (radii.length === 0) return undefined;
    return {
      radius: Math.max(...radii),
      clarity: this.shared.behind.clarity.value,
      paint: 0,
      showsNormals: false,
      height: this.height,
    };
  }

  private lookOf({ material }: BodyDescription): Look {
    return this.looks.get(material) ?? lookOf(undefined);
  }

  private get liquids(): BodyView[] {
    return [...this.bodies.values()].filter(({ isLiquid }) => isLiquid);
  }

  /** Sets the reference of absorption, the length of the darkest liquid, and relative values. */
  private measureClarity(): void {
    const { vat } = this.description!;
    const widths = vat ? sizeOf(vat) : undefined;
    const lengths = this.liquids.map(({ description }) => {
      const width = widths ? Math.min(...widths) : 20 * description.radius;
      return absorptionLengthOf(this.lookOf(description), width);
    });
    if (lengths.length === 0) return;
    const clarity = Math.min(...lengths);
    this.shared.behind.clarity.value = clarity;
    this.liquids.forEach((view, i) => (view.density = clarity / lengths[i]!));
  }

  private moveVat(offset: Vector): void {
    const vat = this.description?.vat;
    if (!vat || !this.vat) return;
    this.vat.moveTo(offset);
    setWalls(this.shared.walls, this.vat.box, vat.lid);
    this.vat.expand(this.seen);
    const [x, y, z] = offset;
    this.shared.floor.floor_z.value = vat.min[2] + z;
    this.shared.floor.reach.value = 0.6 * (vat.max[2] - vat.min[2]);
    const sides = [vat.max[0] - vat.min[0], vat.max[1] - vat.min[1]];
    const tile = Math.max(Math.min(...sides) / 4, Math.max(...sides) / 24);
    this.shared.floor.tile.value = roundLength(tile);
    this.shared.floor.floor_bounds.value.set(
      vat.min[0] + x,
      vat.min[1] + y,
      vat.max[0] + x,
      vat.max[1] + y,
    );
  }

  /** Without a vat, the bodies in the first frame define the extent and the ground. */
  private settle(): void {
    if (this.contents.first.isEmpty()) return;
    this.seen.copy(this.contents.first);
    this.ground.fit(this.seen);
  }

  private clear(): void {
    this.seen.makeEmpty();
    this.contents.clear();
    this.drawing.clear();
    for (const view of this.bodies.values()) view.dispose();
    this.bodies = new Map();
    this.vat?.dispose();
    this.vat = undefined;
    removeWalls(this.shared.walls);
  }
}
