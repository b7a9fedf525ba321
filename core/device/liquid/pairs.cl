// Pairs of particles: neighbours, their lists, and forces. A wall is a mirror, and the sides of a periodic
// axis shift by its period: the images near a particle are the particles near its own images. See core/liquid/tait/weakly_compressible.h for the
// method.

// The kernel wendland_c2, see core/kernels/smoothing_kernel.h.
float kernel_value(float q) {
  const float rest = 1 - q;
  const float rest2 = rest * rest;
  return rest2 * rest2 * (4 * q + 1);
}
float kernel_slope(float q) {
  const float rest = 1 - q;
  return rest * rest * rest;
}

// A mirror: for each axis 0, or 1 for the lower wall, or 2 for the upper wall. Along a periodic axis,
// 1 and 2 are shifts across these sides.
typedef struct {
  int axes[3];
} Mirror;

// Whether a mirror reverses the direction of an axis.
bool reverses(const Parameters* p, const Mirror* m, int axis) {
  return m->axes[axis] > 0 && p->periods[axis] == 0;
}

bool is_shift(const Parameters* p, const Mirror* m) {
  return !reverses(p, m, 0) && !reverses(p, m, 1) && !reverses(p, m, 2);
}

int reflected(const Parameters* p, const Mirror* m, int place, int axis) {
  if (m->axes[axis] == 0) return place;
  const int period = p->periods[axis];
  if (period > 0) return m->axes[axis] == 1 ? place + period : place - period;
  return (m->axes[axis] == 1 ? p->twice_low[axis] : p->twice_high[axis]) - place;
}

// Bit 2 k + 1 of the result: the lower side across axis k is within a support radius. Bit 2 k + 2:
// the upper side.
int sides_near(const Parameters* p, const int* n) {
  const int twice_reach = 2 * p->support;
  int near = 0;
  for (int k = 0; k < 3; ++k) {
    if (((p->sides >> (2 * k)) & 1) && 2 * n[k] - p->twice_low[k] < twice_reach) near |= 2 << (2 * k);
    if (((p->sides >> (2 * k + 1)) & 1) && p->twice_high[k] - 2 * n[k] < twice_reach) {
      near |= 4 << (2 * k);
    }
  }
  return near;
}

// Runs BODY for each mirror `m` whose images may be near the position n: also for no reflection.
#define FOR_EACH_MIRROR(p, n, BODY)                                            \
  {                                                                            \
    const int near = sides_near(p, n);                                         \
    Mirror m;                                                                  \
    for (m.axes[0] = 0; m.axes[0] < 3; ++m.axes[0]) {                          \
      if (m.axes[0] != 0 && !((near >> m.axes[0]) & 1)) continue;              \
      for (m.axes[1] = 0; m.axes[1] < 3; ++m.axes[1]) {                        \
        if (m.axes[1] != 0 && !((near >> (2 + m.axes[1])) & 1)) continue;      \
        for (m.axes[2] = 0; m.axes[2] < 3; ++m.axes[2]) {                      \
          if (m.axes[2] != 0 && !((near >> (4 + m.axes[2])) & 1)) continue;    \
          BODY                                                                 \
        }                                                                      \
      }                                                                        \
    }                                                                          \
  }

// Runs BODY for each row of cells near the position `at`, with the slots [begin, end).
#define FOR_EACH_ROW(p, at, begins, BODY)                                      \
  {                                                                            \
    int low[3];                                                                \
    int high[3];                                                               \
    for (int k = 0; k < 3; ++k) {                                              \
      const int c = at[k] >> (p)->cell_bits;                                   \
      low[k] = clamp(c - (p)->reach, 0, (p)->cells[k] - 1);                             \
      high[k] = clamp(c + (p)->reach, 0, (p)->cells[k] - 1);                            \
    }                                                                          \
    FOR_EACH_ROW_IN(p, low, high, begins, BODY)                                \
  }

// The part of the relative density that a particle and its own images have in excess of 1.
float own_excess(const Parameters* p, const int* n, float weight) {
  float own = 1;
  FOR_EACH_MIRROR(p, n, {
    if (m.axes[0] + m.axes[1] + m.axes[2] == 0) continue;
    float square = 0;
    for (int k = 0; k < 3; ++k) {
      const float way = (float)(n[k] - reflected(p, &m, n[k], k)) * p->in_supports;
      square += way * way;
    }
    if (square < 1) own += kernel_value(sqrt(square));
  })
  return max(0.0f, weight * own - 1);
}

// Lists of neighbours: entry k of slot s is entry_of(s, k). An entry is the slot of the neighbour
// and, in the bits from MIRROR_BITS on, the axes of the mirror. A list with more than LIST_LENGTH
// neighbours is incomplete.
#define LIST_LENGTH 64
#define LIST_GROUP 32
#define MIRROR_BITS 26
#define SLOT_MASK ((1u << MIRROR_BITS) - 1)

int entry_of(int slot, int k) {
  return ((slot / LIST_GROUP) * LIST_LENGTH + k) * LIST_GROUP + slot % LIST_GROUP;
}

uint code_of(const Mirror* m) {
  return (uint)(m->axes[0] + 4 * m->axes[1] + 16 * m->axes[2]) << MIRROR_BITS;
}

Mirror mirror_of(uint code) {
  Mirror m;
  for (int k = 0; k < 3; ++k) m.axes[k] = (code >> (MIRROR_BITS + 2 * k)) & 3;
  return m;
}

// Runs BODY for each source `j` in the cells near a particle at n. `code` is the code of the mirror
// of the image, or 0. `at` is the position n, or its reflection in this mirror.
#define FOR_EACH_CANDIDATE(p, n, begins, BODY)                                 \
  FOR_EACH_MIRROR(p, n, {                                                      \
    int at[3];                                                                 \
    for (int k = 0; k < 3; ++k) at[k] = reflected(p, &m, n[k], k);             \
    const uint code = code_of(&m);                                             \
    FOR_EACH_ROW(p, at, begins, {                                              \
      for (int j = begin; j < end; ++j) BODY                                   \
    })                                                                         \
  })

// Runs BODY for each source `j` that may be near the particle in `slot` at n. `code` is the code of
// the mirror of the image, or 0.
#define FOR_EACH_NEIGHBOUR(p, slot, n, begins, counts, lists, BODY)            \
  if (counts[slot] <= LIST_LENGTH) {                                           \
    const int length = counts[slot];                                           \
    for (int entry = 0; entry < length; ++entry) {                             \
      const uint listed = lists[entry_of(slot, entry)];                        \
      const int j = listed & SLOT_MASK;                                        \
      const uint code = listed & ~SLOT_MASK;                                   \
      BODY                                                                     \
    }                                                                          \
  } else {                                                                     \
    FOR_EACH_CANDIDATE(p, n, begins, BODY)                                     \
  }

// Adds a source to a list.
void list(global uint* lists, int slot, int* count, int source, uint code) {
  if (*count < LIST_LENGTH) lists[entry_of(slot, *count)] = source | code;
  ++*count;
}

// The vector from a source to a target, or to its image at `at`, in support radii.
float3 way_to(const Parameters* p, const int* at, int4 source) {
  return (float3)((float)(at[0] - source.x), (float)(at[1] - source.y), (float)(at[2] - source.z)) *
         p->in_supports;
}

// The direction x from the image in a mirror, seen from the particle that is not reflected.
float3 turned(const Parameters* p, uint code, float3 x) {
  if (code == 0) return x;
  const Mirror m = mirror_of(code);
  return (float3)(reverses(p, &m, 0) ? -x.x : x.x, reverses(p, &m, 1) ? -x.y : x.y,
                  reverses(p, &m, 2) ? -x.z : x.z);
}

// The vector from a source, or from its image, to a target at n, in support radii.
float3 way_from(const Parameters* p, uint code, const int* n, int4 source) {
  if (code == 0) return way_to(p, n, source);
  const Mirror m = mirror_of(code);
  int at[3];
  for (int k = 0; k < 3; ++k) at[k] = reflected(p, &m, n[k], k);
  return turned(p, code, way_to(p, at, source));
}

float square_of(float3 x) {
  return x.x * x.x + x.y * x.y + x.z * x.z;
}

// The pressure of the image of a particle at `place` includes the hydrostatic pressure difference;
// see ImagePressure.
float image_pressure(const Parameters* p, const Mirror* m, int4 place, float pressure) {
  if (!p->is_filled && pressure <= 0) return pressure;
  const int n[3] = {place.x, place.y, place.z};
  float more = 0;
  for (int k = 0; k < 3; ++k) {
    if (p->periods[k] > 0) continue;
    more += p->fall[k] * ((float)(reflected(p, m, n[k], k) - n[k]) * p->unit);
  }
  if (p->is_filled) return pressure + p->density * more;
  return max(0.0f, pressure + pressure / (pressure + p->layer) * (p->density * more));
}

// Avoids a division by 0 in viscous forces: (h/2)^2 / 100 in units of the support radius h.
#define SOFTENING (0.01f / 4)

// Adds the force of a source on a target.
void add_force(const Parameters* p, const int* n, float4 mine, int4 source, float4 its,
               float* sum) {
  const float3 x = way_to(p, n, source);
  const float square = square_of(x);
  if (!(square < 1)) return;
  const float approach = (mine.x - its.x) * x.x + (mine.y - its.y) * x.y + (mine.z - its.z) * x.z;
  const float force = p->viscosity * approach / (square + SOFTENING) - (mine.w + its.w);
  const float share = force * (weight_of(source) * kernel_slope(sqrt(square)));
  sum[0] += share * x.x;
  sum[1] += share * x.y;
  sum[2] += share * x.z;
}

// The velocity of the image of a particle with the velocity v, see mirrored_velocity().
float3 mirrored_velocity(const Parameters* p, const Mirror* m, float4 motion) {
  float v[3] = {motion.x, motion.y, motion.z};
  for (int axis = 0; axis < 3; ++axis) {
    if (!reverses(p, m, axis)) continue;
    const int wall = 2 * axis + m->axes[axis] - 1;
    const bool has_no_slip = (p->no_slip >> wall) & 1;
    for (int k = 0; k < 3; ++k) {
      const float of_wall = p->speeds_of_walls[3 * wall + k];
      if (k == axis || has_no_slip) v[k] = -(v[k] - of_wall) + of_wall;
    }
  }
  return (float3)(v[0], v[1], v[2]);
}

// Whether images in this mirror are viscous, see add_viscous_image_forces().
bool is_viscous(const Parameters* p, const Mirror* m) {
  int walls = 0;
  for (int k = 0; k < 3; ++k) walls |= m->axes[k] > 0 ? 1 << (2 * k + m->axes[k] - 1) : 0;
  return p->is_thick || (walls & p->no_slip);
}

// Adds the force of the reflection of a source on a target. A solid has no viscous force of images.
void add_force_of_image(const Parameters* p, const Mirror* m, const int* n, int is_target_solid,
                        float4 mine, int4 source, float4 its, float* sum) {
  int at[3];
  for (int k = 0; k < 3; ++k) at[k] = reflected(p, m, n[k], k);
  const float3 x = way_to(p, at, source);
  const float square = square_of(x);
  if (!(square < 1)) return;
  const float force = -(mine.w + image_pressure(p, m, source, its.w));
  const float share = force * (weight_of(source) * kernel_slope(sqrt(square)));
  sum[0] += share * (reverses(p, m, 0) ? -x.x : x.x);
  sum[1] += share * (reverses(p, m, 1) ? -x.y : x.y);
  sum[2] += share * (reverses(p, m, 2) ? -x.z : x.z);
  if (is_target_solid || is_solid(source) || !is_viscous(p, m)) return;
  const float3 v = mirrored_velocity(p, m, its);
  const float drag = p->viscosity / (square + SOFTENING) *
                     (weight_of(source) * kernel_slope(sqrt(square)));
  sum[0] += drag * (x.x * x.x) * (mine.x - v.x);
  sum[1] += drag * (x.y * x.y) * (mine.y - v.y);
  sum[2] += drag * (x.z * x.z) * (mine.z - v.z);
}

// Adds the force of a source, or of the image of a source, on a target.
void add_force_of(const Parameters* p, uint code, const int* n, int is_target_solid, float4 mine,
                  int4 source, float4 its, float* sum) {
  if (code == 0) {
    add_force(p, n, mine, source, its, sum);
    return;
  }
  const Mirror m = mirror_of(code);
  if (is_shift(p, &m)) {
    int at[3];
    for (int k = 0; k < 3; ++k) at[k] = reflected(p, &m, n[k], k);
    add_force(p, at, mine, source, its, sum);
  } else {
    add_force_of_image(p, &m, n, is_target_solid, mine, source, its, sum);
  }
}

// The acceleration by the central field at the integer position n.
float field_at(const Parameters* p, int n, int axis) {
  const double x = p->origin[axis] + n / p->inverse_unit;
  return (float)(p->field_strength * (p->field_center[axis] - x));
}

// The acceleration of the particle in `slot` by pressure, viscosity, gravity and settling.
float3 acceleration_of(const Parameters* p, int slot, global const int* begins,
                       global const int4* sorted_place, global const float4* sorted_motion,
                       global const int* counts, global const uint* lists) {
  const int4 own = sorted_place[slot];
  const float4 mine = sorted_motion[slot];
  const int n[3] = {own.x, own.y, own.z};
  float sum[3] = {0, 0, 0};
  FOR_EACH_NEIGHBOUR(p, slot, n, begins, counts, lists, {
    add_force_of(p, code, n, 0, mine, sorted_place[j], sorted_motion[j], sum);
  })
  const float v[3] = {mine.x, mine.y, mine.z};
  float a[3];
  for (int k = 0; k < 3; ++k) {
    a[k] = p->gravity[k] + p->slope_factor * sum[k] - p->drag * (v[k] - p->still[k]);
    if (p->field_strength > 0) a[k] += field_at(p, n[k], k);
  }
  return (float3)(a[0], a[1], a[2]);
}

// Extrapolates the pressure of the surrounding liquid to solids, see extrapolate_pressure().
// p.gravity is the gravity on the liquid.
kernel void find_solid_pressure(const Parameters p, global const int* begins,
                                global const int4* sorted_place, global float4* sorted_motion,
                                global const float* density, global const int* counts,
                                global const uint* lists) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const int4 own = sorted_place[slot];
  if (!is_solid(own)) return;
  const int n[3] = {own.x, own.y, own.z};
  float weights = 0;
  float pressures = 0;
  float3 arms = 0;
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    const int4 source = sorted_place[j];
    if (is_solid(source)) continue;
    const float3 x = way_from(&p, code, n, source);
    const float square = square_of(x);
    if (!(square < 1)) continue;
    const float weight = weight_of(source) * kernel_value(sqrt(square));
    const float s = density[j];
    float pressure = sorted_motion[j].w * (s * s);
    if (code != 0) {
      const Mirror m = mirror_of(code);
      pressure = image_pressure(&p, &m, source, pressure);
    }
    weights += weight;
    pressures += weight * pressure;
    arms += weight * x;
  })
  const float fall = p.gravity[0] * arms.x + p.gravity[1] * arms.y + p.gravity[2] * arms.z;
  const float sum = pressures + p.density * (fall * (p.unit / p.in_supports));
  const float mean = weights > 0 ? sum / weights : 0;
  sorted_motion[slot].w = p.is_filled ? mean : max(0.0f, mean);
}

// The accelerations in the order of particles.
kernel void find_acceleration(const Parameters p, global const int* begins,
                              global const int* order, global const int4* sorted_place,
                              global const float4* sorted_motion, global const int* counts,
                              global const uint* lists, global float4* acceleration) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids || is_solid(sorted_place[slot])) return;
  const float3 a = acceleration_of(&p, slot, begins, sorted_place, sorted_motion, counts, lists);
  acceleration[order[slot]] = (float4)(a, 0);
}

// Adds the forces of the liquid on the particles of solids, see add_tait_forces_on_solids(). `force`
// is indexed by solid particle.
kernel void add_forces_on_solids(const Parameters p, global const int* begins,
                                 global const int* order, global const int4* sorted_place,
                                 global const float4* sorted_motion, global const int* counts,
                                 global const uint* lists, global double* force) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const int4 own = sorted_place[slot];
  if (!is_solid(own)) return;
  const float4 mine = sorted_motion[slot];
  const int n[3] = {own.x, own.y, own.z};
  float sum[3] = {0, 0, 0};
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    if (is_solid(sorted_place[j])) continue;
    add_force_of(&p, code, n, 1, mine, sorted_place[j], sorted_motion[j], sum);
  })
  const float factor = p.solid_factor * weight_of(own);
  for (int k = 0; k < 3; ++k) force[3 * (order[slot] - p.count) + k] += (double)(factor * sum[k]);
}
