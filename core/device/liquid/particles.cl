// Particles of one liquid, and of solids in it, in a vat: parameters, walls, and integer positions. One work-item computes one particle. Solids follow the liquid in the order of particles.
//
// Positions and velocities are in double precision, in the order of the particles. Sums over pairs
// are in the precision of the scene, `real`. They read copies in the order of cells, whose positions
// are integers: p.support units are one support radius, and 2^p.cell_bits units are one cell.
// Differences of such positions are exact.

#ifdef VAT_DOUBLE_PAIRS
typedef double real;
typedef double3 real3;
typedef double4 real4;
typedef long coord;
typedef long4 place4;
#define convert_real3 convert_double3
#define convert_coord_rte convert_long_rte
#define as_real as_double
#define as_coord as_long
// A state has forces, which are mass * acceleration. Without its last three bits, an acceleration
// follows exactly from the rounded force.
double without_last_bits(double a) {
  return as_double((as_long(a) + 4) & ~7L);
}
double3 stored_acceleration(double3 a) {
  return (double3)(without_last_bits(a.x), without_last_bits(a.y), without_last_bits(a.z));
}
#else
typedef float real;
typedef float3 real3;
typedef float4 real4;
typedef int coord;
typedef int4 place4;
#define convert_real3 convert_float3
#define convert_coord_rte convert_int_rte
#define as_real as_float
#define as_coord as_int
#define stored_acceleration(a) (a)
#endif

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
  real gravity[3];
  real still[3];
  real drag;
  real fall[3];
  real unit;
  real in_supports;
  real density;
  real layer;
  real stiffness;
  real tension;
  real slope_factor;
  real viscosity;
  real solid_factor;
  real speeds_of_walls[18];
  coord twice_low[3];
  coord twice_high[3];
  coord periods[3];
  int cells[3];
  int cell_bits;
  int reach;
  coord support;
  int walls;
  int sides;
  int no_slip;
  int is_thick;
  int bounces;
  int is_filled;
  int count;
  int solids;
  int list_length;
} Parameters;

// Kernels of scenes with several liquids have a table of them, and the index of the liquid in each
// slot; for solids, that of the first particle. They use copies of the parameters with the values of
// the liquids of a pair.
#ifdef VAT_SEVERAL_LIQUIDS
typedef struct {
  real density_factor;
  real density;
  real layer_share;
  real stiffness;
  real slope_factor;
  real viscosity;
  real slope_weight;
} Liquid;
#define LIQUIDS , global const Liquid* liquids, global const uchar* liquid_in
#define PASS_LIQUIDS , liquids, liquid_in
#define COPY_PARAMETERS(own, p)                                                \
  Parameters own##_copy = *(p);                                                \
  Parameters* own = &own##_copy
// Sets the values of the target in `slot`.
#define SET_TARGET(own, slot)                                                  \
  {                                                                            \
    const Liquid of_target = liquids[liquid_in[slot]];                            \
    own->stiffness = of_target.stiffness;                                         \
    own->slope_factor = of_target.slope_factor;                                   \
  }
// Sets the values of the source in slot j. Between liquids, the viscosity is 2 a b / (a + b), see
// set_liquid_viscosities(); between a liquid and a solid, that of the liquid.
#define SET_SOURCE(own, p, is_target_solid, slot, j, place)                    \
  {                                                                            \
    const Liquid of_source = liquids[liquid_in[j]];                               \
    own->density = of_source.density;                                             \
    own->layer = (p)->layer * of_source.layer_share;                              \
    const real a = liquids[liquid_in[slot]].viscosity;                         \
    const real b = of_source.viscosity;                                           \
    own->viscosity = is_target_solid      ? b                                  \
                     : is_solid(place)    ? a                                  \
                     : a + b > 0          ? 2 * a * b / (a + b)                \
                                          : 0;                                 \
  }
// Scales the sum of weights and the own weight of a target to its kernel.
#define SCALE_DENSITY(place, sum, slot)                                        \
  sum *= liquids[liquid_in[slot]].density_factor;                              \
  place.w = as_coord(as_real(place.w) * liquids[liquid_in[slot]].density_factor);
// Weights of a source in sums over gradients for solids, and in the hydrostatic pressure of solids.
#define SET_SLOPE_WEIGHT(place, j)                                             \
  place.w = as_coord(as_real(place.w) * liquids[liquid_in[j]].slope_weight);
#define DENSITY_WEIGHT(p, j, weight) (weight * (liquids[liquid_in[j]].density / (p)->density))
#else
#define LIQUIDS
#define PASS_LIQUIDS
#define COPY_PARAMETERS(own, p) const Parameters* own = p
#define SET_TARGET(own, slot)
#define SET_SOURCE(own, p, is_target_solid, slot, j, place)
#define SCALE_DENSITY(place, sum, slot)
#define SET_SLOPE_WEIGHT(place, j)
#define DENSITY_WEIGHT(p, j, weight) weight
#endif

// Limit of positions, so that differences of positions and images fit into a coord.
#define PLACE_LIMIT ((coord)1 << (8 * sizeof(coord) - 3))

int cell_along(coord place, int count, int bits) {
  return clamp(place >> bits, (coord)0, (coord)(count - 1));
}

// Whether a position is in a box. In this form, a NaN fails.
bool is_in_box(const double* low, const double* high, double3 x) {
  return (x.x >= low[0]) & (x.x <= high[0]) & (x.y >= low[1]) & (x.y <= high[1]) &
         (x.z >= low[2]) & (x.z <= high[2]);
}

// See is_within().
bool is_sound(const Parameters* p, double3 x, double3 v) {
  return (v.x * v.x + v.y * v.y + v.z * v.z <= p->greatest_speed2) &
         is_in_box(p->domain_low, p->domain_high, x);
}

bool is_between_walls(const Parameters* p, double3 x) {
  return is_in_box(p->wall_low, p->wall_high, x);
}

// Reflects a particle beyond walls. If the reflected position is beyond another wall, the particle
// is moved to the wall. The outward velocity is reversed if p.bounces is set, and removed otherwise.
bool reflect_at_walls(const Parameters* p, double3* at, double3* motion) {
  if (is_between_walls(p, *at)) return false;
  double x[3] = {at->x, at->y, at->z};
  double v[3] = {motion->x, motion->y, motion->z};
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
    if (!is_between_walls(p, (double3)(x[0], x[1], x[2]))) x[k] = plane;
  }
  *at = (double3)(x[0], x[1], x[2]);
  *motion = (double3)(v[0], v[1], v[2]);
  return is_stopped;
}

// The weight of a source is its rest volume times the scale of the kernel. It is stored with a
// negative sign for solids.
bool is_solid(place4 place) {
  return as_real(place.w) < 0;
}
real weight_of(place4 place) {
  return fabs(as_real(place.w));
}

// The cell of an integer position.
int cell_at(const Parameters* p, place4 n) {
  const int x = cell_along(n.x, p->cells[0], p->cell_bits);
  const int y = cell_along(n.y, p->cells[1], p->cell_bits);
  const int z = cell_along(n.z, p->cells[2], p->cell_bits);
  return (z * p->cells[1] + y) * p->cells[0] + x;
}

// The integer position along an axis.
coord place_along(const Parameters* p, double x, int axis, global int* status) {
  const double image = wrapped(x, p->origin[axis], p->period[axis]);
  const double coordinate = (image - p->origin[axis]) * p->inverse_unit;
  // In this form, a NaN fails.
  if (coordinate >= -PLACE_LIMIT && coordinate <= PLACE_LIMIT) return convert_coord_rte(coordinate);
  atomic_or(status + kFault, 1);
  return 0;
}

// Adds a particle with the velocity w to its cell.
void enter_cell(const Parameters* p, int i, double3 x, real3 w, global const real* weight,
                global place4* place, global real4* motion, global int* cell_of, global int* rank,
                global int* cell_counts, global int* status) {
  const place4 n = (place4)(place_along(p, x.x, 0, status), place_along(p, x.y, 1, status),
                        place_along(p, x.z, 2, status), as_coord(weight[i]));
  place[i] = n;
  motion[i] = (real4)(w, 0);
  const int cell = cell_at(p, n);
  cell_of[i] = cell;
  rank[i] = atomic_inc(cell_counts + cell);
}

// Enters solids at rest into their cells.
kernel void enter_solids(const Parameters p, global const double* solid_position,
                         global const real* weight, global place4* place, global real4* motion,
                         global int* cell_of, global int* rank, global int* cell_counts,
                         global int* status) {
  const int b = get_global_id(0);
  if (b >= p.solids) return;
  enter_cell(&p, p.count + b, vload3(b, solid_position), 0, weight, place, motion, cell_of, rank,
             cell_counts, status);
}

// Enters moving solids into their cells.
kernel void enter_moving_solids(const Parameters p, global const double* solid_position,
                                global const double* solid_velocity, global const real* weight,
                                global place4* place, global real4* motion, global int* cell_of,
                                global int* rank, global int* cell_counts, global int* status) {
  const int b = get_global_id(0);
  if (b >= p.solids) return;
  enter_cell(&p, p.count + b, vload3(b, solid_position), convert_real3(vload3(b, solid_velocity)),
             weight, place, motion, cell_of, rank, cell_counts, status);
}

// Integers behind each column of positions, which vectors may read.
#define COLUMN_END 16

// Copies the particles in the order of cells.
kernel void collect(const int count, global const int* cell_of, global const int* begins,
                    global const int* unsorted, global const place4* place,
                    global const real4* motion, global int* order, global place4* sorted_place,
                    global real4* sorted_motion, global int* columns
#ifdef VAT_SEVERAL_LIQUIDS
                    , global const uchar* liquid_of, global uchar* liquid_in
#endif
                    ) {
  const int t = get_global_id(0);
  if (t >= count) return;
  const int i = unsorted[t];
  const int slot = slot_in_cell(i, cell_of, begins, unsorted);
  order[slot] = i;
  sorted_place[slot] = place[i];
  sorted_motion[slot] = motion[i];
#ifdef VAT_SEVERAL_LIQUIDS
  liquid_in[slot] = liquid_of[i];
#endif
#if LANES > 1
  const place4 own = place[i];
  columns[slot] = own.x;
  columns[slot + count + COLUMN_END] = own.y;
  columns[slot + 2 * (count + COLUMN_END)] = own.z;
#endif
}
