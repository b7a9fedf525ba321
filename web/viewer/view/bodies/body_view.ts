import { Group, Matrix4, Mesh } from 'three';
import type { Ray, ShaderMaterial, Vector3 } from 'three';
import { BodyKind } from '../../../client/index';
import type { BodyDescription, FrameHeader, GridBlock, PoseBlock } from '../../../client/index';
import type { Look } from '../base/appearance';
import { nearestSphere } from '../base/pick';
import type { Hit } from '../base/pick';
import { kNoValue } from '../colour/maps';
import { kQuantities, quantityOf } from '../colour/quantity';
import type { Range } from '../colour/range';
import { bodyUniforms, kColourSource } from '../particles/impostor';
import type { BodyUniforms, DrawnUniforms } from '../particles/impostor';
import type { LiquidStyle } from '../base/liquid_style';
import { bodyColour } from '../base/palette';
import { ParticleColumns } from '../particles/particle_columns';
import { RigidMotion } from '../particles/rigid_motion';
import type { Choice } from '../base/settings';
import { shadowMaterial } from '../particles/shadow_material';
import type { SolidSurface } from '../solids/solid';
import type { SolidMaker } from '../solids/solid_of';
import { BodyPlaces } from './body_places';
import type { LiquidBody } from '../fluid/liquid_body';
import type { SolidParticles } from '../fluid/solid_neighbours';
import type { GridParticles } from '../particles/joined_grids';
import type { RigidParticles } from '../particles/joined_particles';
import type { SharedUniforms } from './shared_uniforms';
import { sphereMaterial } from '../particles/sphere_material';
import { Skin } from '../surface/skin';
import type { Workshop } from '../surface/workshop';

/** Draw order: shadows on the floor, then solids. */
const kOrder = { shadow: 1, solid: 2, skin: 3 };

/** Sizes of skins; see SurfaceJob. If particles are shown too, skins enclose the spheres. */
const kSkinSizes = { liquid: 1.5, deformable: 1.2, rigid: 1.2 };
/** The opacity of the surface of a perfectly clear liquid. */
const kLeastOpacity = 0.6;
/** Radius of the spheres that the pointer hits / particle radius. They cover a surface. */
const kReach = 1.42;
/** Distributes the variants of bodies evenly. */
const kGoldenRatio = 0.618034;
const kVeil = { opacity: 0.4, size: 1.7 };

/**
 * The particles of one body. The group's matrix converts their coordinates to world axes: quanta for
 * liquid and deformable bodies, body axes for rigid bodies. Therefore a new frame uploads only the
 * received integers or a pose.
 */
export class BodyView {
  readonly group = new Group();
  readonly columns: ParticleColumns;
  readonly uniforms: BodyUniforms;
  readonly places: BodyPlaces;
  /** The motion of a rigid body; undefined for others. */
  readonly motion: RigidMotion | undefined;
  private readonly materials: ShaderMaterial[] = [];
  private colouring: Choice<'colour'> = 'material';
  /** Soft shadows on the floor below particles. */
  private readonly spots: Mesh;
  private readonly spheres: Mesh;
  private readonly skin: Skin;
  /** The surface of a solid with a known shape. */
  private solid: SolidSurface | undefined;
  private solidStyleNow: Choice<'solids'> = 'shape';
  /** Of a liquid: its absorption relative to the reference of the scene. */
  density = 1;
  /** The strain at which links of a deformable body tear; undefined: they do not. */
  tearingStrain: number | undefined;
  private values: Float32Array | undefined;
  /** Simulated time of the newest frame [s]. */
  private time = 0;
  private hasSkin = false;
  /** Whether the skin is transparent, so that particles are visible. */
  private isVeiled = false;
  /** See SurfaceJob. */
  private skinSize: number;

  constructor(
    readonly description: BodyDescription,
    private readonly nthOfKind: number,
    private appearance: Look,
    private readonly shared: SharedUniforms,
    workshop: Workshop,
    onChange: () => void,
  ) {
    const { kind, radius, particles, local_positions: local } = description;
    this.columns = new ParticleColumns(local ? local.length / 3 : particles, local);
    this.motion = kind === 'rigid' ? new RigidMotion() : undefined;
    this.uniforms = bodyUniforms(bodyColour(kind, nthOfKind), shared.look, !this.motion);
    this.places = new BodyPlaces(this.columns, this.group, this.uniforms, radius);
    this.group.matrixAutoUpdate = false;
    this.group.visible = false; // until the first frame
    this.spots = this.add(shadowMaterial(radius, shared.floor, this.drawn), kOrder.shadow);
    this.spheres = this.add(sphereMaterial(this.drawn, radius), kOrder.solid);
    this.skin = new Skin(workshop, this.uniforms, onChange);
    this.skinSize = kSkinSizes[kind];
    this.skin.mesh.renderOrder = kOrder.skin;
    this.group.add(this.skin.mesh);
    this.liquidStyle = 'splats';
    this.uniforms.variant.value = (nthOfKind * kGoldenRatio) % 1;
    this.look = appearance;
  }

  /** Sets the appearance of the material. */
  set look(look: Look) {
    this.appearance = look;
    const { uniforms } = this;
    uniforms.roughness.value = look.roughness;
    uniforms.metalness.value = look.metalness;
    if (this.solid) this.solid.finish = look.finish;
    if (uniforms.colour_source.value === kColourSource.body) this.showColour(kColourSource.body);
    this.showOpacity();
  }

  /** The uniforms of materials that draw its particles. */
  get drawn(): DrawnUniforms {
    return { ...this.uniforms, ...this.columns.uniforms };
  }

  get count(): number {
    return this.columns.count;
  }

  /** Returns whether it can show another body, the n-th of its kind. */
  isOf({ body, kind, radius }: BodyDescription, nthOfKind: number): boolean {
    const { description } = this;
    const isSame = body === description.body && kind === description.kind;
    return isSame && radius === description.radius && nthOfKind === this.nthOfKind;
  }

  /** Adds the surface of a solid. Until then, its particles are visible. */
  addSolid(make: SolidMaker): void {
    if (this.solid) return;
    const solid = make(this.description, this.uniforms, this.shared);
    if (!solid) return;
    this.solid = solid;
    this.look = this.appearance;
    solid.mesh.renderOrder = kOrder.solid;
    this.group.add(solid.mesh);
    this.solidStyle = this.solidStyleNow;
  }

  /** Ends the interpolation: the next frame does not continue the motion. */
  rest(): void {
    this.solid?.rest?.();
    this.columns.rest();
    this.motion?.rest();
  }

  /** Shows particles. See ParticleColumns.show() for the lifetime of the block. */
  showGrid(block: GridBlock, { origin, quantum, attributeQuanta, time }: FrameHeader): void {
    this.columns.show(block, { origin, quantum });
    const name = quantityOf(this.colouring);
    const column = name && kQuantities[name].column;
    const values = column === undefined ? undefined : block.attributes[column];
    if (values && column !== undefined) {
      this.columns.showValues(values);
      this.uniforms.value_quantum.value = attributeQuanta[column]!;
    }
    const scale = this.uniforms.value_quantum.value;
    const hasSurface = this.skin.mesh.visible || this.solid?.mesh.visible === true;
    this.values = hasSurface && values ? Float32Array.from(values, (v) => v * scale) : undefined;
    this.showColour(values ? kColourSource.column : kColourSource.body);
    this.group.matrix.makeScale(quantum, quantum, quantum).setPosition(...origin);
    this.shown();
    this.time = time;
    this.updateSkin();
    this.updateSolid();
  }

  /** Shows a pose, `seconds` after the previous one. */
  showPose(block: PoseBlock, seconds: number): void {
    if (!this.motion) return;
    this.motion.add(block);
    this.motion.matrixAt(1, this.group.matrix);
    this.motion.velocities(seconds, this.uniforms.linear.value, this.uniforms.angular.value);
    const isKnown = this.colouring === 'speed' && seconds > 0;
    this.showColour(isKnown ? kColourSource.motion : kColourSource.body);
    this.shown();
    this.updateSkin();
  }

  /** Interpolates a rigid body between its last two poses. Shaders interpolate other bodies. */
  set phase(phase: number) {
    if (!this.motion) return;
    this.motion.matrixAt(phase, this.group.matrix);
    this.group.matrixWorldNeedsUpdate = true;
  }

  /** Sets the coloured quantity, from the next frame on. */
  set colour(colouring: Choice<'colour'>) {
    this.colouring = colouring;
    this.showColour(kColourSource.body);
  }

  /** Returns the range of the coloured quantity; without values, from infinity to -infinity. */
  valueRange(values: Int32Array | undefined): Range {
    const { value_quantum: quantum, linear } = this.uniforms;
    const range = { min: Infinity, max: -Infinity };
    if (this.uniforms.colour_source.value === kColourSource.motion) {
      range.min = range.max = linear.value.length();
    } else if (values) {
      for (const value of values) {
        range.min = Math.min(range.min, value * quantum.value);
        range.max = Math.max(range.max, value * quantum.value);
      }
    }
    return range;
  }

  /** Returns the number of the first particle on the ray, and its distance [m]. */
  pick(ray: Ray): Hit | undefined {
    if (!this.group.visible) return undefined;
    const scale = this.group.matrix.getMaxScaleOnAxis();
    const local = ray.clone().applyMatrix4(new Matrix4().copy(this.group.matrix).invert());
    local.direction.normalize();
    const places = this.columns.coordinates(this.uniforms.phase.value);
    const reach = this.solid?.mesh.visible ? kReach : 1;
    const hit = nearestSphere(local, places, (reach * this.description.radius) / scale);
    if (!hit) return undefined;
    return { particle: this.columns.numberAt(hit.particle), distance: hit.distance * scale };
  }

  /** Returns the world position of a particle number; undefined if it is not shown. */
  positionOf(particle: number): Vector3 | undefined {
    const place = this.columns.placeOf(particle);
    return place === undefined ? undefined : this.places.at(place);
  }

  get isLiquid(): boolean {
    return this.description.kind === 'liquid';
  }

  /** Whether it is a rigid body. */
  get isRigid(): boolean {
    return this.motion !== undefined;
  }

  /** The surface of a rigid body, if it can be drawn together with those of other bodies. */
  get joinable(): SolidSurface | undefined {
    const { solid } = this;
    return solid?.mesh.visible && solid.opacity === 1 ? solid : undefined;
  }

  /** The particles of a liquid or deformable body. */
  get gridParticles(): Omit<GridParticles & LiquidBody, 'row'> {
    const { spheres, spots, columns, description, uniforms } = this;
    const { body, radius } = description;
    return { body, radius, spheres, spots, columns, valueQuantum: uniforms.value_quantum.value };
  }

  /** The particles of a rigid body. */
  get particles(): Omit<RigidParticles, 'row'> {
    const { spheres, spots, description } = this;
    return { spheres, spots, places: description.local_positions ?? [] };
  }

  /** The particles of a deformable or rigid body in the newest frame. */
  get solidParticles(): SolidParticles {
    const { columns, description, motion, group } = this;
    const toWorld = motion ? motion.matrixAt(1, new Matrix4()) : group.matrix;
    const places = description.local_positions ?? columns.newestPlaces();
    return { places, count: this.count, toWorld, radius: description.radius };
  }

  /** The longest side of the surface, 1 without a surface [m]. */
  get bodyLength(): number {
    return this.solid?.bodyLength ?? 1;
  }

  dispose(): void {
    this.group.removeFromParent();
    this.columns.dispose();
    this.skin.dispose();
    this.solid?.dispose();
    for (const material of this.materials) material.dispose();
  }

  /** Sets the style of a liquid. Does not affect other bodies. */
  set liquidStyle(chosen: LiquidStyle) {
    if (!this.isLiquid) return;
    this.spheres.visible = chosen === 'particles';
    this.spots.visible = chosen !== 'fluid'; // it is in the shadow map
    this.skin.mesh.visible = chosen === 'surface';
    this.updateSkin();
  }

  /** Sets the style of a deformable or rigid body. Does not affect liquids. */
  set solidStyle(chosen: Choice<'solids'>) {
    const { kind } = this.description;
    if (kind === 'liquid') return;
    this.solidStyleNow = chosen;
    const hasShape = chosen === 'shape' && this.solid !== undefined;
    this.spheres.visible = chosen !== 'skin' && !hasShape;
    this.spots.visible = !hasShape; // shapes are in the shadow map
    this.skin.mesh.visible = chosen === 'skin' || chosen === 'both';
    if (this.solid) this.solid.mesh.visible = hasShape;
    this.solid?.rest?.();
    this.updateSolid();
    this.isVeiled = chosen === 'both';
    this.showOpacity();
    this.skinSize = this.isVeiled ? kVeil.size : kSkinSizes[kind];
    this.hasSkin = false;
    this.updateSkin();
  }

  private showOpacity(): void {
    const { opacity } = this.appearance;
    const shown = this.isLiquid ? kLeastOpacity + (1 - kLeastOpacity) * opacity : opacity;
    if (this.solid) this.solid.opacity = opacity;
    this.skin.opacity = this.isVeiled ? kVeil.opacity : shown;
  }

  /** Updates the skin. A rigid body's skin moves with it; others are made anew. */
  private updateSkin(): void {
    if (!this.skin.mesh.visible || this.count === 0 || !this.group.visible) return;
    if (this.motion && this.hasSkin) return;
    this.hasSkin = true;
    const radius = this.description.radius / this.group.matrix.getMaxScaleOnAxis();
    const places = this.columns.newestPlaces();
    this.skin.follow({ places, radius, values: this.values, size: this.skinSize });
  }

  /** Moves the surface of a deformable body to the newest particles. */
  private updateSolid(): void {
    if (!this.solid?.mesh.visible || !this.group.visible) return;
    const { columns, time, tearingStrain, values } = this;
    const quantum = this.group.matrix.getMaxScaleOnAxis();
    this.solid.follow?.({ columns, quantum, time, tearingStrain, values });
  }

  /** Sets the source of colours. Particles without a value are grey. */
  private showColour(source: number): void {
    const { kind } = this.description;
    this.uniforms.colour_source.value = source;
    const isOfNumbers = quantityOf(this.colouring) !== undefined;
    const { value } = this.uniforms.colour;
    if (isOfNumbers) value.copy(kNoValue);
    else if (this.colouring === 'material' || this.colouring === 'normals')
      value.copy(this.appearance.colour);
    else value.copy(bodyColour(kind, this.colouring === 'kind' ? 0 : this.nthOfKind));
  }

  private add(material: ShaderMaterial, order: number): Mesh {
    const mesh = new Mesh(this.columns.geometry, material);
    mesh.frustumCulled = false; // the geometry has no bounds
    mesh.renderOrder = order;
    this.group.add(mesh);
    this.materials.push(material);
    return mesh;
  }

  private shown(): void {
    this.group.matrixWorldNeedsUpdate = true;
    this.group.visible = true;
  }
}

export function isGrid(block: { kind: number }): block is GridBlock {
  return block.kind === BodyKind.liquid || block.kind === BodyKind.deformable;
}
