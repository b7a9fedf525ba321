import { Color, DoubleSide, Mesh, ShaderMaterial } from 'three';
import type { BufferGeometry, IUniform } from 'three';
import { placeOfParticle } from '../particles/impostor';
import type { DrawnUniforms } from '../particles/impostor';
import { kLayers } from '../base/layers';
import type { ParticleColumns } from '../particles/particle_columns';

// prettier-ignore
/** Vertices (across, along): the shaft from 0 to 1, the head from 2 (base) to 3 (tip). */
const kVertices = [
  [-1, 0], [1, 0], [1, 1], [-1, 0], [1, 1], [-1, 1],
  [-1, 2], [1, 2], [0, 3],
];
const kCorners = kVertices.map(([across, along]) => `vec2(${across}, ${along})`).join();

const kVertexShader = /* glsl */ `
  ${placeOfParticle(kVertices.length)}
  const vec2 kCorners[${kVertices.length}] = vec2[${kVertices.length}](${kCorners});
  uniform float interval;
  uniform float seconds;
  uniform float radius;
  uniform uint every;
  uniform bool is_rigid;

  void main() {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside of the picture
    read_particle();
    vec2 corner = kCorners[vertex];
    // A scattered selection, because rows of arrows would hide one another.
    if (((number * 2654435761u) >> 8) % every != 0u || interval <= 0.0) return;
    Body body = this_body();
    vec3 place = place_of_particle();
    vec3 world = (body.to_world * vec4(place, 1.0)).xyz;
    float size_of_particle = radius_of_body(radius);
    if (is_clipped(world)) return;
    vec3 velocity = is_rigid
      ? body.linear + cross(body.angular, mat3(body.to_world) * place)
      : mat3(body.to_world) * (center - before) / interval;
    vec3 base = (viewMatrix * vec4(world, 1.0)).xyz;
    vec3 way = mat3(viewMatrix) * (seconds * velocity);
    float size = length(way);
    if (size < 0.25 * size_of_particle) return;
    vec3 across = normalize(cross(way, base));
    float head = min(0.45 * size, 1.3 * size_of_particle);
    float shaft = size - 0.9 * head;
    float along = corner.y < 1.5 ? shaft * corner.y : size - head * (3.0 - corner.y);
    float width = corner.y < 1.5 ? 0.16 : 0.62;
    vec3 point = base + along * way / size + width * head * corner.x * across;
    gl_Position = projectionMatrix * vec4(point, 1.0);
  }
`;

const kFragmentShader = /* glsl */ `
  uniform vec3 ink;
  void main() {
    gl_FragColor = vec4(ink, 0.9);
    #include <colorspace_fragment>
  }
`;

/** The uniforms of all arrows. */
export interface ArrowUniforms extends Record<string, IUniform> {
  ink: IUniform<Color>;
  /** An arrow ends at the particle's extrapolated position after this time [s]. */
  seconds: IUniform<number>;
  /** Number of particles per arrow. */
  every: IUniform<number>;
}

export function arrowUniforms(): ArrowUniforms {
  return { ink: { value: new Color() }, seconds: { value: 0 }, every: { value: 1 } };
}

/** Returns arrows along the velocities of particles, drawn over the scene. */
export function arrowMesh(
  columns: ParticleColumns,
  body: DrawnUniforms,
  radius: number,
  isRigid: boolean,
  arrows: ArrowUniforms,
): Mesh<BufferGeometry, ShaderMaterial> {
  const material = new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    uniforms: {
      ...body,
      ...arrows,
      radius: { value: radius },
      is_rigid: { value: isRigid },
    },
    side: DoubleSide,
    transparent: true,
    depthTest: false,
    depthWrite: false,
  });
  const mesh = new Mesh(columns.shapedAs(kVertices.length), material);
  mesh.frustumCulled = false;
  mesh.visible = false;
  mesh.renderOrder = 8;
  mesh.layers.set(kLayers.marks);
  return mesh;
}
