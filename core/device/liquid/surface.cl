// Surface tension of a liquid by curvature; see core/liquid/surface/surface_tension.h. All arrays but
// the accelerations are in the order of cells. Vectors of images are turned() with their mirror.

typedef struct {
  float slope;      // g / sum over pairs [1/m]
  float threshold;  // least |g| of a particle at the surface [1/m]
  float spread;     // curvature / quotient of sums [1/m]
  float lift;       // see lift_to_surface() [m]
  float tension;    // acceleration / (curvature * |g|) [m^3/s^2]
  float cohesion;   // pressure / deficiency [Pa]
  float cosine;     // of the contact angle with walls
  float sine;
} Surface;

// The rigid motion that balances the curvature forces. Lengths are in support radii.
typedef struct {
  double excess[3];
  double turn[3];
  double center[3];
} Balance;

// Sets g_i, and in the fourth component max(0, 1 - s_i).
kernel void find_surface(const Parameters p, const Surface s, global const int* begins,
                         global const int4* sorted_place, global const int* counts,
                         global const uint* lists, global float4* surface) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const int4 own = sorted_place[slot];
  if (is_solid(own)) return;
  const int n[3] = {own.x, own.y, own.z};
  float3 gradient = 0;
  float sum = 0;
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    const int4 source = sorted_place[j];
    const float3 x = way_from(&p, code, n, source);
    const float square = square_of(x);
    if (!(square < 1)) continue;
    const float q = sqrt(square);
    sum += weight_of(source) * kernel_value(q);
    gradient += weight_of(source) * kernel_slope(q) * x;
  })
  surface[slot] = (float4)(s.slope * gradient, max(0.0f, 1 - sum));
}

float length_of(float3 x) {
  return sqrt(square_of(x));
}

// The normal of a surface at the contact angle with a wall across `axis`, see contact_normal().
float3 contact_normal(const Surface* s, float3 normal, int axis, float inwards) {
  float n[3] = {normal.x, normal.y, normal.z};
  n[axis] = 0;
  const float length = length_of((float3)(n[0], n[1], n[2]));
  if (!(length > 0)) return 0;
  for (int k = 0; k < 3; ++k) n[k] *= s->sine / length;
  n[axis] = -s->cosine * inwards;
  return (float3)(n[0], n[1], n[2]);
}

float dot_of(float3 a, float3 b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Interpolates normals near walls to the contact normal.
float3 turn_at_walls(const Parameters* p, const Surface* s, const int* n, float3 normal) {
  if (s->cosine == 0) return normal;
  for (int wall = 0; wall < 6; ++wall) {
    if (!((p->walls >> wall) & 1)) continue;
    const int axis = wall / 2;
    const bool is_low = wall % 2 == 0;
    const int twice = is_low ? 2 * n[axis] - p->twice_low[axis] : p->twice_high[axis] - 2 * n[axis];
    const float q = 0.5f * (float)twice * p->in_supports;
    if (q >= 1) continue;
    const float3 contact = contact_normal(s, normal, axis, is_low ? 1 : -1);
    const float share = 1 - max(0.0f, q);
    const float3 sum = share * contact + (1 - share) * normal;
    const float length = length_of(sum);
    if (length_of(contact) > 0 && length > 0) normal = sum / length;
  }
  return normal;
}

// The normal of the image of a particle: reflected at the contact normal.
float3 image_normal(const Parameters* p, const Surface* s, uint code, float3 normal) {
  if (s->cosine == 0) return turned(p, code, normal);
  const Mirror m = mirror_of(code);
  for (int axis = 0; axis < 3; ++axis) {
    if (!reverses(p, &m, axis)) continue;
    const float3 contact = contact_normal(s, normal, axis, m.axes[axis] == 1 ? 1 : -1);
    if (length_of(contact) > 0) normal = 2 * dot_of(contact, normal) * contact - normal;
  }
  return normal;
}

// Sets the normals of particles at the surface, and 0 for others. The fourth component is |g_i|.
kernel void find_surface_normals(const Parameters p, const Surface s, global const int* begins,
                                 global const int4* sorted_place, global const int* counts,
                                 global const uint* lists, global const float4* surface,
                                 global float4* normals) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const int4 own = sorted_place[slot];
  normals[slot] = 0;
  if (is_solid(own)) return;
  const float steepness = length_of(surface[slot].xyz);
  if (!(steepness > s.threshold)) return;
  const int n[3] = {own.x, own.y, own.z};
  float3 sum = 0;
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    const int4 source = sorted_place[j];
    if (is_solid(source)) continue;
    const float square = square_of(way_from(&p, code, n, source));
    if (!(square < 1)) continue;
    sum += weight_of(source) * kernel_value(sqrt(square)) * turned(&p, code, surface[j].xyz);
  })
  const float length = length_of(sum);
  if (!(length > 0)) return;
  normals[slot] = (float4)(turn_at_walls(&p, &s, n, sum / length), steepness);
}

bool is_normal(float4 normal) {
  return normal.x != 0 || normal.y != 0 || normal.z != 0;
}

// Sets the accelerations by curvature, and adds those by the attraction at the surface.
kernel void find_curvature_forces(const Parameters p, const Surface s, global const int* begins,
                                  global const int* order, global const int4* sorted_place,
                                  global const int* counts, global const uint* lists,
                                  global const float4* surface, global const float4* normals,
                                  global float4* curved, global float4* acceleration) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const int4 own = sorted_place[slot];
  if (is_solid(own)) return;
  const int n[3] = {own.x, own.y, own.z};
  const float4 normal = normals[slot];
  const float deficiency = surface[slot].w;
  float3 pull = 0;
  float spread = 0;
  float weights = 0;
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    const int4 source = sorted_place[j];
    if (is_solid(source)) continue;
    const float3 x = way_from(&p, code, n, source);
    const float square = square_of(x);
    if (!(square < 1)) continue;
    const float q = sqrt(square);
    const float share = weight_of(source) * kernel_slope(q);
    pull += share * (s.cohesion * (deficiency + surface[j].w)) * x;
    const float4 its = normals[j];
    if (!is_normal(its)) continue;
    const float3 other = code == 0 ? its.xyz : image_normal(&p, &s, code, its.xyz);
    spread += share * dot_of(normal.xyz - other, x);
    weights += weight_of(source) * kernel_value(q);
  })
  acceleration[order[slot]] += (float4)(p.slope_factor * pull, 0);
  float strength = 0;
  if (is_normal(normal)) {
    const float curvature = s.spread * spread / weights;
    strength = s.tension * normal.w * curvature / (1 + max(-0.5f, s.lift * curvature));
  }
  curved[slot] = (float4)(strength * normal.xyz, 0);
}

// Sums over the surface, see SurfaceSum: force, torque, moment, and the ten numbers of the weights
// and second moments. Forces and weights are relative to the density and the surface tension.
#define SURFACE_SUMS 6

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void sum_surface(
    const Parameters p, const int groups, global const int4* sorted_place,
    global const float4* normals, global const float4* curved, global double4* partial) {
  local double4 sums[GROUP];
  const int slot = get_global_id(0);
  double4 own[SURFACE_SUMS];
  for (int k = 0; k < SURFACE_SUMS; ++k) own[k] = 0;
  if (slot < p.count) {
    const int4 place = sorted_place[slot];
    const double weight = weight_of(place);
    const double share = is_normal(normals[slot]) ? weight * normals[slot].w : 0;
    const double x = (double)place.x * p.in_supports;
    const double y = (double)place.y * p.in_supports;
    const double z = (double)place.z * p.in_supports;
    const double fx = weight * curved[slot].x;
    const double fy = weight * curved[slot].y;
    const double fz = weight * curved[slot].z;
    own[0] = (double4)(fx, fy, fz, 0);
    own[1] = (double4)(y * fz - z * fy, z * fx - x * fz, x * fy - y * fx, 0);
    own[2] = (double4)(share * x, share * y, share * z, 0);
    own[3] = (double4)(share, share * x * x, share * y * y, 0);
    own[4] = (double4)(share * z * z, share * x * y, share * x * z, 0);
    own[5] = (double4)(share * y * z, 0, 0, 0);
  }
  for (int k = 0; k < SURFACE_SUMS; ++k) {
    write_partial(sums, own[k], partial + k * groups);
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void end_surface_sums(
    const int groups, global const double4* partial, global double4* results) {
  local double4 sums[GROUP];
  for (int k = 0; k < SURFACE_SUMS; ++k) {
    const double4 total = sum_partial(sums, groups, partial + k * groups);
    if (get_local_id(0) == 0) results[k] = total;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

// Adds the balanced accelerations by curvature.
kernel void add_curvature_forces(const Parameters p, const Balance balance,
                                 global const int* order, global const int4* sorted_place,
                                 global const float4* normals, global const float4* curved,
                                 global float4* acceleration) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const int4 place = sorted_place[slot];
  if (is_solid(place)) return;
  const double at[3] = {(double)place.x * p.in_supports - balance.center[0],
                        (double)place.y * p.in_supports - balance.center[1],
                        (double)place.z * p.in_supports - balance.center[2]};
  const double share = is_normal(normals[slot]) ? normals[slot].w : 0;
  const float4 own = curved[slot];
  const double a[3] = {own.x, own.y, own.z};
  float sum[3];
  for (int k = 0; k < 3; ++k) {
    const int k1 = (k + 1) % 3;
    const int k2 = (k + 2) % 3;
    const double turned = balance.turn[k1] * at[k2] - balance.turn[k2] * at[k1];
    sum[k] = (float)(a[k] - share * (balance.excess[k] + turned));
  }
  acceleration[order[slot]] += (float4)(sum[0], sum[1], sum[2], 0);
}
