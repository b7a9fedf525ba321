// Cohesion of a liquid, and adhesion to walls and solids; see core/liquid/surface/cohesion.h.

typedef struct {
  float pull;           // acceleration / sum over pairs of weight * slope * x
  float pull_of_solid;  // force on a solid / its weight and the same sum
  float inverse_far;    // support radius / reach of the far part of the kernel
  float inverse_near;
  float far_slope;  // dU/dr / r of the parts at the distance 0
  float near_slope;
  float far_plane;  // acceleration by the parts of a wall / wendland_over_plane()
  float near_plane;
  float wall_share;  // attraction by walls, relative to that by the liquid
  int dimensions;
} Cohesion;

float cohesion_shape(float q) {
  const float rest = q < 1 ? 1 - q : 0;
  const float rest2 = rest * rest;
  return rest2 * rest2 * rest * (1 + 5 * q);
}

// dU/dr / r at the distance q in support radii. `share` scales the far part.
float cohesion_slope(const Cohesion* c, float share, float q) {
  return share * c->far_slope * cohesion_shape(q * c->inverse_far) +
         c->near_slope * cohesion_shape(q * c->inverse_near);
}

float wendland_c4(float q) {
  const float rest = q < 1 ? 1 - q : 0;
  const float rest2 = rest * rest;
  return rest2 * rest2 * rest2 * (1 + q * (6 + 35.0f / 3 * q));
}

// Gauss-Legendre nodes on [0, 1], and their weights.
constant float kNodes[8] = {0.01985507f, 0.10166676f, 0.23723380f, 0.40828268f,
                            0.59171732f, 0.76276620f, 0.89833324f, 0.98014493f};
constant float kNodeWeights[8] = {0.05061427f, 0.11119052f, 0.15685332f, 0.18134189f,
                                  0.18134189f, 0.15685332f, 0.11119052f, 0.05061427f};

// The integral of wendland_c4 over the plane at the distance q, without its factor 2 pi or 2.
float wendland_over_plane(int dimensions, float q) {
  if (q >= 1) return 0;
  const float width = sqrt(1 - q * q);
  float sum = 0;
  for (int n = 0; n < 8; ++n) {
    if (dimensions == 3) {
      const float r = q + (1 - q) * kNodes[n];
      sum += kNodeWeights[n] * (1 - q) * r * wendland_c4(r);
    } else {
      const float x = width * kNodes[n];
      sum += kNodeWeights[n] * width * wendland_c4(sqrt(q * q + x * x));
    }
  }
  return sum;
}

// The acceleration by the walls.
float3 pull_of_walls(const Parameters* p, const Cohesion* c, const int* n) {
  float a[3] = {0, 0, 0};
  for (int wall = 0; wall < 6; ++wall) {
    if (!((p->walls >> wall) & 1)) continue;
    const int axis = wall / 2;
    const bool is_low = wall % 2 == 0;
    const int twice = is_low ? 2 * n[axis] - p->twice_low[axis] : p->twice_high[axis] - 2 * n[axis];
    const float q = max(0.0f, 0.5f * (float)twice * p->in_supports);
    const float pull = c->wall_share * c->far_plane *
                           wendland_over_plane(c->dimensions, q * c->inverse_far) +
                       c->near_plane * wendland_over_plane(c->dimensions, q * c->inverse_near);
    a[axis] += is_low ? -pull : pull;
  }
  return (float3)(a[0], a[1], a[2]);
}

// The sum of weight * slope * x over the sources in the reach of the kernel. For a liquid target, all
// sources count; for a solid one, the liquid. p.reach and p.support are those of the kernel, and p.sides
// has no walls. `shares` is in the order of particles.
float3 cohesion_sum(const Parameters* p, const Cohesion* c, int slot, global const int* begins,
                    global const int* order, global const int4* sorted_place,
                    global const float* shares) {
  const int4 own = sorted_place[slot];
  const int n[3] = {own.x, own.y, own.z};
  const bool is_target_solid = is_solid(own);
  const float own_share = shares[order[slot]];
  float3 sum = 0;
  FOR_EACH_CANDIDATE(p, n, begins, {
    const int4 source = sorted_place[j];
    if (is_target_solid && is_solid(source)) continue;
    const float3 x = way_to(p, at, source);
    const float square = square_of(x);
    if (!(square * c->inverse_far * c->inverse_far < 1)) continue;
    const float share = is_target_solid ? own_share : shares[order[j]];
    sum += weight_of(source) * cohesion_slope(c, share, sqrt(square)) * x;
  })
  return sum;
}

// Adds the accelerations of the liquid.
kernel void add_cohesion(const Parameters p, const Cohesion c, global const int* begins,
                         global const int* order, global const int4* sorted_place,
                         global const float* shares, global float4* acceleration) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids || is_solid(sorted_place[slot])) return;
  const int4 own = sorted_place[slot];
  const int n[3] = {own.x, own.y, own.z};
  const float3 sum = cohesion_sum(&p, &c, slot, begins, order, sorted_place, shares);
  acceleration[order[slot]] += (float4)(c.pull * sum + pull_of_walls(&p, &c, n), 0);
}

// Adds the forces on the particles of solids. `force` is indexed by solid particle.
kernel void add_adhesion_on_solids(const Parameters p, const Cohesion c, global const int* begins,
                                   global const int* order, global const int4* sorted_place,
                                   global const float* shares, global double* force) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids || !is_solid(sorted_place[slot])) return;
  const float3 sum = cohesion_sum(&p, &c, slot, begins, order, sorted_place, shares);
  const float factor = c.pull_of_solid * weight_of(sorted_place[slot]);
  const float f[3] = {factor * sum.x, factor * sum.y, factor * sum.z};
  for (int k = 0; k < 3; ++k) force[3 * (order[slot] - p.count) + k] += (double)f[k];
}
