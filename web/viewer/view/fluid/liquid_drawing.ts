import { Box3, Color, Group, Matrix4, Mesh, Vector3 } from 'three';
import type { ShaderMaterial } from 'three';
import { kLayers } from '../base/layers';
import type { LiquidStyle } from '../base/liquid_style';
import type { WallUniforms } from './wall_uniforms';
import type { LookUniforms } from '../colour/look_uniforms';
import { bodyUniforms } from '../particles/impostor';
import { JoinedColumns } from '../particles/joined_columns';
import { splatDepthMaterial, splatMaterial } from '../particles/splat_material';
import { fluidDepthMaterial, fluidShadowMaterial, fluidThicknessMaterial } from './fluid_particles';
import type { BehindUniforms } from './fluid_pass';
import { Froth } from './froth';
import { kReach, SurfaceShapes } from './surface_shapes';
import { solidsNear } from './solid_neighbours';
import type { SolidParticles } from './solid_neighbours';
import type { LiquidBody, LiquidTime } from './liquid_body';

/** The shared uniforms of liquids. */
interface LiquidUniforms {
  look: LookUniforms;
  behind: BehindUniforms;
  walls: WallUniforms;
}

/** Draws all liquids together in the styles fluid and splats. */
export class LiquidDrawing {
  readonly group = new Group();
  private readonly joined = new JoinedColumns();
  private readonly froth = new Froth();
  private readonly shapes = new SurfaceShapes();
  private readonly walls: WallUniforms;
  private readonly uniforms;
  private readonly meshes: { mesh: Mesh; style: LiquidStyle }[] = [];
  private drawn: LiquidStyle = 'splats';
  /** Whether the foam is that of the present columns. Only the style fluid needs it. */
  private hasFroth = false;

  constructor({ look, behind, walls }: LiquidUniforms) {
    this.uniforms = bodyUniforms(new Color(), look, true);
    this.walls = walls;
    const uniforms = { ...this.uniforms, ...this.joined.uniforms };
    this.add(splatDepthMaterial(uniforms, 1), 'splats', 'splats', 1);
    this.add(splatMaterial(uniforms, 1), 'splats', 'splats', 2);
    this.add(fluidDepthMaterial(uniforms, 1, walls), 'fluid', 'fluidDepth');
    this.add(fluidThicknessMaterial(uniforms, 1, behind), 'fluid', 'fluidThickness');
    this.add(fluidShadowMaterial(uniforms, 1, behind), 'fluid', 'liquidShadow');
    this.style = this.drawn;
  }

  set style(style: LiquidStyle) {
    this.drawn = style;
    for (const { mesh, style: own } of this.meshes) mesh.visible = style === own;
  }

  /** Draws these liquids, which touch these solids. Called before each picture. */
  update(
    liquids: readonly LiquidBody[],
    solids: () => readonly SolidParticles[],
    time: LiquidTime,
  ): void {
    const { drawn, joined } = this;
    this.group.visible = liquids.length > 0 && (drawn === 'fluid' || drawn === 'splats');
    if (!this.group.visible) return;
    if (joined.update(liquids)) {
      this.uniforms.value_quantum.value = liquids[0]!.valueQuantum;
      this.hasFroth = false;
    }
    if (drawn !== 'fluid' || this.hasFroth) return;
    this.froth.follow(liquids, joined, time);
    this.shapeSurface(liquids, solids(), time);
    this.hasFroth = true;
  }

  /** Forgets the foam, before another scene. */
  clear(): void {
    this.froth.clear();
  }

  private shapeSurface(
    liquids: readonly LiquidBody[],
    solids: readonly SolidParticles[],
    { origin, quantum }: LiquidTime,
  ): void {
    const { center, shapes } = this.joined.columns;
    const count = liquids.reduce((sum, { columns }) => sum + columns.count, 0);
    const radius = Math.max(...liquids.map((liquid) => liquid.radius)) / quantum;
    const fromWorld = new Matrix4().makeScale(quantum, quantum, quantum);
    fromWorld.setPosition(...origin).invert();
    const onGrid = ({ value }: { value: Vector3 }): number[] =>
      value.clone().applyMatrix4(fromWorld).toArray();
    const walls = { low: onGrid(this.walls.wall_low), high: onGrid(this.walls.wall_high) };
    const liquid = center.values.subarray(0, 3 * count);
    const reach = kReach * radius;
    const touched = solidsNear(solids, fromWorld, boxOf(liquid), reach, radius);
    const places = new Float32Array(liquid.length + touched.places.length);
    places.set(liquid);
    places.set(touched.places, liquid.length);
    this.shapes.write(places, count, touched.weights, radius, walls, shapes.values);
    shapes.changed();
  }

  private add(
    material: ShaderMaterial,
    style: LiquidStyle,
    layer: keyof typeof kLayers,
    order = 0,
  ): void {
    const mesh = new Mesh(this.joined.geometry, material);
    mesh.frustumCulled = false; // the geometry has no bounds
    mesh.renderOrder = order;
    mesh.layers.set(kLayers[layer]);
    this.group.add(mesh);
    this.meshes.push({ mesh, style });
  }
}

function boxOf(places: ArrayLike<number>): Box3 {
  const box = new Box3();
  const place = new Vector3();
  for (let i = 0; i < places.length; i += 3) box.expandByPoint(place.fromArray(places, i));
  return box;
}
