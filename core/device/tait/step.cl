// A step of a weakly compressible liquid in a vat. One work-item computes one particle.
//
// Positions and velocities are in double precision, in the order of the particles. Sums over pairs
// are in single precision. They read copies in the order of cells, whose positions are integers:
// p.support units are one support radius, and 2^p.cell_bits units are one cell. Differences of such
// positions are exact. A wall is a mirror: the images near a particle are the particles near its own images.
// See core/liquid/tait/weakly_compressible.h for the method.

#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#ifdef VAT_EXACT
#pragma OPENCL FP_CONTRACT OFF
#endif

typedef struct {
  double origin[3];
  double inverse_unit;
  double wall_low[3];
  double wall_high[3];
  double wall_velocity[3];
  double domain_low[3];
  double domain_high[3];
  double greatest_speed2;
  double closing;
  double opening;
  double drift;
  double prediction;
  float gravity[3];
  float still[3];
  float drag;
  float fall[3];
  float unit;
  float in_supports;
  float density;
  float layer;
  float stiffness;
  float slope_factor;
  float viscosity;
  int twice_low[3];
  int twice_high[3];
  int cells[3];
  int cell_bits;
  int reach;
  int support;
  int walls;
  int count;
} Parameters;

enum { kFault = 0, kStops = 1 };

// Limit of positions, so that differences of positions and images fit into 32 bits.
#define PLACE_LIMIT (1 << 29)

int cell_along(int place, int count, int bits) {
  return clamp(place >> bits, 0, count - 1);
}

bool is_sound(const Parameters* p, const double* x, const double* v) {
  bool sound = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] <= p->greatest_speed2;
  for (int k = 0; k < 3; ++k) {
    sound = sound && x[k] >= p->domain_low[k] && x[k] <= p->domain_high[k];
  }
  return sound;
}

bool is_between_walls(const Parameters* p, const double* x) {
  bool inside = true;
  for (int k = 0; k < 3; ++k) inside = inside && x[k] >= p->wall_low[k] && x[k] <= p->wall_high[k];
  return inside;
}

// Reflects a particle beyond walls. If the reflected position is beyond another wall, the particle
// is moved to the wall.
bool reflect_at_walls(const Parameters* p, double* x, double* v) {
  bool is_stopped = false;
  for (int k = 0; k < 3; ++k) {
    const bool is_low = x[k] < p->wall_low[k];
    if (!is_low && !(x[k] > p->wall_high[k])) continue;
    is_stopped = true;
    const double plane = is_low ? p->wall_low[k] : p->wall_high[k];
    const double image = plane - (x[k] - plane);
    const double speed = v[k] - p->wall_velocity[k];
    if (is_low ? speed < 0 : speed > 0) v[k] = 2 * p->wall_velocity[k] - v[k];
    x[k] = image;
    if (!is_between_walls(p, x)) x[k] = plane;
  }
  return is_stopped;
}

// Ends a step: loads the particle, kicks it and checks its state.
void end_step(const Parameters* p, int i, global const double* position,
              global const double* velocity, const float* a, double* x, double* v,
              global int* status) {
  for (int k = 0; k < 3; ++k) {
    x[k] = position[3 * i + k];
    v[k] = velocity[3 * i + k] + p->closing * (double)a[k];
  }
  if (p->closing > 0 && !is_sound(p, x, v)) atomic_or(status + kFault, 1);
}

// Ends a step with a kick, and begins the next one with a kick and a drift. Counts the particles of
// each cell.
kernel void move(const Parameters p, global double* position, global double* velocity,
                 global const float4* acceleration, global const float* weight,
                 global int4* place, global float4* motion, global int* cell_of, global int* rank,
                 global int* cell_counts, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  const float4 a4 = acceleration[i];
  const float a[3] = {a4.x, a4.y, a4.z};
  double x[3];
  double v[3];
  end_step(&p, i, position, velocity, a, x, v, status);
  for (int k = 0; k < 3; ++k) {
    v[k] += p.opening * (double)a[k];
    x[k] += p.drift * v[k];
  }
  if (p.drift > 0 && reflect_at_walls(&p, x, v)) atomic_inc(status + kStops);
  float w[3];
  int n[3];
  int c[3];
  for (int k = 0; k < 3; ++k) {
    position[3 * i + k] = x[k];
    velocity[3 * i + k] = v[k];
    w[k] = (float)(v[k] + p.prediction * (double)a[k]);
    const double coordinate = (x[k] - p.origin[k]) * p.inverse_unit;
    // In this form, a NaN fails.
    const bool fits = coordinate >= -PLACE_LIMIT && coordinate <= PLACE_LIMIT;
    if (!fits) atomic_or(status + kFault, 1);
    n[k] = fits ? convert_int_rte(coordinate) : 0;
    c[k] = cell_along(n[k], p.cells[k], p.cell_bits);
  }
  place[i] = (int4)(n[0], n[1], n[2], as_int(weight[i]));
  motion[i] = (float4)(w[0], w[1], w[2], 0);
  const int cell = (c[2] * p.cells[1] + c[1]) * p.cells[0] + c[0];
  cell_of[i] = cell;
  rank[i] = atomic_inc(cell_counts + cell);
}

// Kicks the particles at the end of the last step.
kernel void finish(const Parameters p, global const double* position, global double* velocity,
                   global const float4* acceleration, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  const float4 a4 = acceleration[i];
  const float a[3] = {a4.x, a4.y, a4.z};
  double x[3];
  double v[3];
  end_step(&p, i, position, velocity, a, x, v, status);
  for (int k = 0; k < 3; ++k) velocity[3 * i + k] = v[k];
}

// Prefix sums of `values` in blocks of SCAN_BLOCK. The last one writes the total behind the end.
#define SCAN_ITEMS 4
#define SCAN_GROUP 256
#define SCAN_BLOCK (SCAN_ITEMS * SCAN_GROUP)

// Replaces the values of a group by the sums of the values before them. Returns the total.
int scan_group(local int* values, int own, int* before) {
  const int t = get_local_id(0);
  values[t] = own;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int width = 1; width < SCAN_GROUP; width *= 2) {
    const int other = t >= width ? values[t - width] : 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    values[t] += other;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  *before = values[t] - own;
  return values[SCAN_GROUP - 1];
}

kernel __attribute__((reqd_work_group_size(SCAN_GROUP, 1, 1))) void sum_blocks(
    const int count, global const int* values, global int* block_sums) {
  local int sums[SCAN_GROUP];
  const int first = get_global_id(0) * SCAN_ITEMS;
  int own = 0;
  for (int k = 0; k < SCAN_ITEMS; ++k) own += first + k < count ? values[first + k] : 0;
  int before;
  const int total = scan_group(sums, own, &before);
  if (get_local_id(0) == 0) block_sums[get_group_id(0)] = total;
}

// One group.
kernel __attribute__((reqd_work_group_size(SCAN_GROUP, 1, 1))) void scan_sums(
    const int count, global int* block_sums) {
  local int sums[SCAN_GROUP];
  int carried = 0;
  for (int first = 0; first < count; first += SCAN_GROUP) {
    const int n = first + get_local_id(0);
    int before;
    const int total = scan_group(sums, n < count ? block_sums[n] : 0, &before);
    if (n < count) block_sums[n] = carried + before;
    carried += total;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

kernel __attribute__((reqd_work_group_size(SCAN_GROUP, 1, 1))) void scan_blocks(
    const int count, global const int* values, global const int* block_sums, global int* begins) {
  local int sums[SCAN_GROUP];
  const int first = get_global_id(0) * SCAN_ITEMS;
  int own[SCAN_ITEMS];
  int total = 0;
  for (int k = 0; k < SCAN_ITEMS; ++k) {
    own[k] = first + k < count ? values[first + k] : 0;
    total += own[k];
  }
  int before;
  scan_group(sums, total, &before);
  before += block_sums[get_group_id(0)];
  for (int k = 0; k < SCAN_ITEMS; ++k) {
    if (first + k < count) begins[first + k] = before;
    before += own[k];
    if (first + k == count - 1) begins[count] = before;
  }
}

kernel void scatter(const int count, global const int* cell_of, global const int* rank,
                    global const int* begins, global int* unsorted) {
  const int i = get_global_id(0);
  if (i < count) unsorted[begins[cell_of[i]] + rank[i]] = i;
}

// Copies the particles in the order of cells. Within a cell, they are in the order of particles,
// because the order of atomic operations differs from run to run.
kernel void collect(const int count, global const int* cell_of, global const int* begins,
                    global const int* unsorted, global const int4* place,
                    global const float4* motion, global int* order, global int4* sorted_place,
                    global float4* sorted_motion) {
  const int t = get_global_id(0);
  if (t >= count) return;
  const int i = unsorted[t];
  const int begin = begins[cell_of[i]];
  const int end = begins[cell_of[i] + 1];
  int slot = begin;
  for (int k = begin; k < end; ++k) slot += unsorted[k] < i;
  order[slot] = i;
  sorted_place[slot] = place[i];
  sorted_motion[slot] = motion[i];
}

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

// Pressure / (density at rest * square of the speed of sound); see tait_pressure().
float tait_pressure(float s) {
  const float end = 1.03f;
  const float at_end = 0.032839123f;  // (end^7 - 1) / 7
  const float slope = 0.9f;
  if (s > 2) return at_end + slope * (1 / end - 0.5f + (s - 2) / 4);
  if (s > end) return at_end + slope * (1 / end - 1 / s);
  // Equal to (s^7 - 1) / 7, without the cancellation of s^7 and 1.
  const float e = s - 1;
  return e * (1 + s * (1 + s * (1 + s * (1 + s * (1 + s * (1 + s)))))) / 7;
}

// A mirror: for each axis 0, or 1 for the lower wall, or 2 for the upper wall.
typedef struct {
  int axes[3];
} Mirror;

int reflected(const Parameters* p, const Mirror* m, int place, int axis) {
  if (m->axes[axis] == 0) return place;
  return (m->axes[axis] == 1 ? p->twice_low[axis] : p->twice_high[axis]) - place;
}

// Bit 2 k + 1 of the result: the lower wall across axis k is within a support radius. Bit 2 k + 2:
// the upper wall.
int walls_near(const Parameters* p, const int* n) {
  const int twice_reach = 2 * p->support;
  int near = 0;
  for (int k = 0; k < 3; ++k) {
    if (((p->walls >> (2 * k)) & 1) && 2 * n[k] - p->twice_low[k] < twice_reach) near |= 2 << (2 * k);
    if (((p->walls >> (2 * k + 1)) & 1) && p->twice_high[k] - 2 * n[k] < twice_reach) {
      near |= 4 << (2 * k);
    }
  }
  return near;
}

// Runs BODY for each mirror `m` whose images may be near the position n: also for no reflection.
#define FOR_EACH_MIRROR(p, n, BODY)                                            \
  {                                                                            \
    const int near = walls_near(p, n);                                         \
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
    for (int z = low[2]; z <= high[2]; ++z) {                                  \
      for (int y = low[1]; y <= high[1]; ++y) {                                \
        const int row = (z * (p)->cells[1] + y) * (p)->cells[0];               \
        const int begin = begins[row + low[0]];                                \
        const int end = begins[row + high[0] + 1];                             \
        BODY                                                                   \
      }                                                                        \
    }                                                                          \
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

// The vector from a source to a target, or to its image at `at`, in support radii.
float3 way_to(const Parameters* p, const int* at, int4 source) {
  return (float3)((float)(at[0] - source.x), (float)(at[1] - source.y), (float)(at[2] - source.z)) *
         p->in_supports;
}

float square_of(float3 x) {
  return x.x * x.x + x.y * x.y + x.z * x.z;
}

// Lists the neighbours of each particle. Sets the fourth component of sorted_motion to pressure /
// s^2 for the relative density s.
kernel void find_pressure(const Parameters p, global const int* begins,
                          global const int4* sorted_place, global float4* sorted_motion,
                          global int* counts, global uint* lists) {
  const int slot = get_global_id(0);
  if (slot >= p.count) return;
  const int4 own = sorted_place[slot];
  const int n[3] = {own.x, own.y, own.z};
  float sum = 0;
  int count = 0;
  FOR_EACH_MIRROR(&p, n, {
    int at[3];
    for (int k = 0; k < 3; ++k) at[k] = reflected(&p, &m, n[k], k);
    const uint code = code_of(&m);
    FOR_EACH_ROW(&p, at, begins, {
      for (int j = begin; j < end; ++j) {
        const int4 other = sorted_place[j];
        const float square = square_of(way_to(&p, at, other));
        if (!(square < 1)) continue;
        sum += as_float(other.w) * kernel_value(sqrt(square));
        if (count < LIST_LENGTH) lists[entry_of(slot, count)] = j | code;
        ++count;
      }
    })
  })
  if (sum > 1) sum -= own_excess(&p, n, as_float(own.w));
  sorted_motion[slot].w = max(0.0f, p.stiffness * tait_pressure(sum)) / (sum * sum);
  counts[slot] = count;
}

// The pressure of the image of a particle at `place` includes the hydrostatic pressure difference;
// see ImagePressure.
float image_pressure(const Parameters* p, const Mirror* m, int4 place, float pressure) {
  if (pressure <= 0) return pressure;
  const int n[3] = {place.x, place.y, place.z};
  float more = 0;
  for (int k = 0; k < 3; ++k) {
    more += p->fall[k] * ((float)(reflected(p, m, n[k], k) - n[k]) * p->unit);
  }
  return max(0.0f, pressure + pressure / (pressure + p->layer) * (p->density * more));
}

// Adds the force of a source on a target.
void add_force(const Parameters* p, const int* n, float4 mine, int4 source, float4 its,
               float* sum) {
  const float softening = 0.01f / 4;
  const float3 x = way_to(p, n, source);
  const float square = square_of(x);
  if (!(square < 1)) return;
  const float approach = (mine.x - its.x) * x.x + (mine.y - its.y) * x.y + (mine.z - its.z) * x.z;
  const float force = p->viscosity * approach / (square + softening) - (mine.w + its.w);
  const float share = force * (as_float(source.w) * kernel_slope(sqrt(square)));
  sum[0] += share * x.x;
  sum[1] += share * x.y;
  sum[2] += share * x.z;
}

// Adds the force of the image of a source on a target.
void add_force_of_image(const Parameters* p, const Mirror* m, const int* n, float4 mine,
                        int4 source, float4 its, float* sum) {
  int at[3];
  for (int k = 0; k < 3; ++k) at[k] = reflected(p, m, n[k], k);
  const float3 x = way_to(p, at, source);
  const float square = square_of(x);
  if (!(square < 1)) return;
  const float force = -(mine.w + image_pressure(p, m, source, its.w));
  const float share = force * (as_float(source.w) * kernel_slope(sqrt(square)));
  sum[0] += share * (m->axes[0] > 0 ? -x.x : x.x);
  sum[1] += share * (m->axes[1] > 0 ? -x.y : x.y);
  sum[2] += share * (m->axes[2] > 0 ? -x.z : x.z);
}

kernel void find_acceleration(const Parameters p, global const int* begins,
                              global const int* order, global const int4* sorted_place,
                              global const float4* sorted_motion, global const int* counts,
                              global const uint* lists, global float4* acceleration) {
  const int slot = get_global_id(0);
  if (slot >= p.count) return;
  const int4 own = sorted_place[slot];
  const float4 mine = sorted_motion[slot];
  const int n[3] = {own.x, own.y, own.z};
  const int count = counts[slot];
  float sum[3] = {0, 0, 0};
  if (count <= LIST_LENGTH) {
    for (int k = 0; k < count; ++k) {
      const uint entry = lists[entry_of(slot, k)];
      const int j = entry & ((1u << MIRROR_BITS) - 1);
      if (entry >> MIRROR_BITS == 0) {
        add_force(&p, n, mine, sorted_place[j], sorted_motion[j], sum);
      } else {
        const Mirror m = mirror_of(entry);
        add_force_of_image(&p, &m, n, mine, sorted_place[j], sorted_motion[j], sum);
      }
    }
  } else {
    FOR_EACH_MIRROR(&p, n, {
      int at[3];
      for (int k = 0; k < 3; ++k) at[k] = reflected(&p, &m, n[k], k);
      const bool is_image = code_of(&m) != 0;
      FOR_EACH_ROW(&p, at, begins, {
        for (int j = begin; j < end; ++j) {
          if (is_image) {
            add_force_of_image(&p, &m, n, mine, sorted_place[j], sorted_motion[j], sum);
          } else {
            add_force(&p, n, mine, sorted_place[j], sorted_motion[j], sum);
          }
        }
      })
    })
  }
  const float v[3] = {mine.x, mine.y, mine.z};
  float a[3];
  for (int k = 0; k < 3; ++k) {
    a[k] = p.gravity[k] + p.slope_factor * sum[k] - p.drag * (v[k] - p.still[k]);
  }
  acceleration[order[slot]] = (float4)(a[0], a[1], a[2], 0);
}
