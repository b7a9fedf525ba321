// Particles of one liquid, and of solids in it, in a vat: parameters, walls, and integer positions. One work-item computes one particle. Solids follow the liquid in the order of particles.
//
// Positions and velocities are in double precision, in the order of the particles. Sums over pairs
// are in single precision. They read copies in the order of cells, whose positions are integers:
// p.support units are one support radius, and 2^p.cell_bits units are one cell. Differences of such
// positions are exact.

typedef struct {
  double origin[3];
  double inverse_unit;
  double wall_low[3];
  double wall_high[3];
  double wall_velocity[3];
  double period[3];
  double domain_low[3];
  double domain_high[3];
  double greatest_speed2;
  double closing;
  double opening;
  double drift;
  double prediction;
  double field_center[3];
  double field_strength;
  float gravity[3];
  float still[3];
  float drag;
  float fall[3];
  float unit;
  float in_supports;
  float density;
  float layer;
  float stiffness;
  float tension;
  float slope_factor;
  float viscosity;
  float solid_factor;
  float speeds_of_walls[18];
  int twice_low[3];
  int twice_high[3];
  int periods[3];
  int cells[3];
  int cell_bits;
  int reach;
  int support;
  int walls;
  int sides;
  int no_slip;
  int is_thick;
  int bounces;
  int is_filled;
  int count;
  int solids;
} Parameters;

// Limit of positions, so that differences of positions and images fit into 32 bits.
#define PLACE_LIMIT (1 << 29)

int cell_along(int place, int count, int bits) {
  return clamp(place >> bits, 0, count - 1);
}

bool is_sound(const Parameters* p, const double* x, const double* v) {
  return is_within(p->domain_low, p->domain_high, p->greatest_speed2, x, v);
}

bool is_between_walls(const Parameters* p, const double* x) {
  bool inside = true;
  for (int k = 0; k < 3; ++k) inside = inside && x[k] >= p->wall_low[k] && x[k] <= p->wall_high[k];
  return inside;
}

// Reflects a particle beyond walls. If the reflected position is beyond another wall, the particle
// is moved to the wall. The outward velocity is reversed if p.bounces is set, and removed otherwise.
bool reflect_at_walls(const Parameters* p, double* x, double* v) {
  bool is_stopped = false;
  for (int k = 0; k < 3; ++k) {
    const bool is_low = x[k] < p->wall_low[k];
    if (!is_low && !(x[k] > p->wall_high[k])) continue;
    is_stopped = true;
    const double plane = is_low ? p->wall_low[k] : p->wall_high[k];
    const double image = plane - (x[k] - plane);
    const double speed = v[k] - p->wall_velocity[k];
    if (is_low ? speed < 0 : speed > 0) {
      v[k] = p->bounces ? 2 * p->wall_velocity[k] - v[k] : p->wall_velocity[k];
    }
    x[k] = image;
    if (!is_between_walls(p, x)) x[k] = plane;
  }
  return is_stopped;
}

// The weight of a source is its rest volume times the scale of the kernel. It is stored with a
// negative sign for solids.
bool is_solid(int4 place) {
  return as_float(place.w) < 0;
}
float weight_of(int4 place) {
  return fabs(as_float(place.w));
}

// Adds a particle with the velocity w to its cell.
void enter_cell(const Parameters* p, int i, const double* x, const float* w,
                global const float* weight, global int4* place, global float4* motion,
                global int* cell_of, global int* rank, global int* cell_counts,
                global int* status) {
  int n[3];
  int c[3];
  for (int k = 0; k < 3; ++k) {
    const double image = wrapped(x[k], p->origin[k], p->period[k]);
    const double coordinate = (image - p->origin[k]) * p->inverse_unit;
    // In this form, a NaN fails.
    const bool fits = coordinate >= -PLACE_LIMIT && coordinate <= PLACE_LIMIT;
    if (!fits) atomic_or(status + kFault, 1);
    n[k] = fits ? convert_int_rte(coordinate) : 0;
    c[k] = cell_along(n[k], p->cells[k], p->cell_bits);
  }
  place[i] = (int4)(n[0], n[1], n[2], as_int(weight[i]));
  motion[i] = (float4)(w[0], w[1], w[2], 0);
  const int cell = (c[2] * p->cells[1] + c[1]) * p->cells[0] + c[0];
  cell_of[i] = cell;
  rank[i] = atomic_inc(cell_counts + cell);
}

// Enters solids at rest into their cells.
kernel void enter_solids(const Parameters p, global const double* solid_position,
                         global const float* weight, global int4* place, global float4* motion,
                         global int* cell_of, global int* rank, global int* cell_counts,
                         global int* status) {
  const int b = get_global_id(0);
  if (b >= p.solids) return;
  double x[3];
  for (int k = 0; k < 3; ++k) x[k] = solid_position[3 * b + k];
  const float w[3] = {0, 0, 0};
  enter_cell(&p, p.count + b, x, w, weight, place, motion, cell_of, rank, cell_counts, status);
}

// Enters moving solids into their cells.
kernel void enter_moving_solids(const Parameters p, global const double* solid_position,
                                global const double* solid_velocity, global const float* weight,
                                global int4* place, global float4* motion, global int* cell_of,
                                global int* rank, global int* cell_counts, global int* status) {
  const int b = get_global_id(0);
  if (b >= p.solids) return;
  double x[3];
  float w[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = solid_position[3 * b + k];
    w[k] = (float)solid_velocity[3 * b + k];
  }
  enter_cell(&p, p.count + b, x, w, weight, place, motion, cell_of, rank, cell_counts, status);
}

// Integers behind each column of positions, which vectors may read.
#define COLUMN_END 16

// Copies the particles in the order of cells.
kernel void collect(const int count, global const int* cell_of, global const int* begins,
                    global const int* unsorted, global const int4* place,
                    global const float4* motion, global int* order, global int4* sorted_place,
                    global float4* sorted_motion, global int* columns) {
  const int t = get_global_id(0);
  if (t >= count) return;
  const int i = unsorted[t];
  const int slot = slot_in_cell(i, cell_of, begins, unsorted);
  order[slot] = i;
  sorted_place[slot] = place[i];
  sorted_motion[slot] = motion[i];
#if LANES > 1
  const int4 own = place[i];
  columns[slot] = own.x;
  columns[slot + count + COLUMN_END] = own.y;
  columns[slot + 2 * (count + COLUMN_END)] = own.z;
#endif
}
