// Forces within gas-like liquids, see core/liquid/gas/liquid.h. The particles of liquids are the
// first of the bodies, and have the cells, contacts and walls of the others. All numbers are in
// double precision. Each particle sums over its neighbours in the order of cells.

// The constants of the liquid of a material.
typedef struct {
  double support;
  double density_scale;   // of the kernel Poly6
  double pressure_slope;  // 3 times the scale of the kernel Spiky
  double viscosity;       // mu times the scale of the Laplacian of the viscosity kernel
  double rest_density;
  double stiffness;       // pressure / excess of density, times the share of the pressure
  double wall_viscosity;  // mu
} Gas;

typedef struct {
  double drag;      // of settling, 1/s
  double still[3];  // velocity that the settling drag leaves
  int no_slip;      // bit w: liquid does not slip along wall w
  int padding;
} GasStep;

// Runs BODY for each particle `j` in `slot` that is closer to the place `at` than `support`, and of
// the same material as `i`. `way` is the vector from j to i, and `square` the square of its length.
#define FOR_EACH_GAS_NEIGHBOUR(BODY)                                           \
  {                                                                            \
    FOR_EACH_ROW_OF_SOLIDS(&p, at, support, begins, {                       \
      FOR_EACH_NEAR(&p, sorted, begin, end, at, shift, support * support, -1, { \
        const int j = order[slot];                                             \
        if (j == i || j >= p.liquids) continue;                                \
        if (bodies[body_of[j]].material != material) continue;                 \
        const double3 way = at - sorted_at(&p, sorted, slot) + shift;          \
        const double square = product(way, way);                               \
        BODY                                                                   \
      })                                                                       \
    })                                                                         \
  }

// The volume of each particle, its pressure times the share, and its velocity in forces. All are in
// the order of cells. The fourth component of `sorted_velocity` is the density / that with liquid beyond
// no-slip walls.
kernel void find_gas_pressure(const Solids p, const GasStep step, global const int* begins,
                              global const int* order, global const double* sorted,
                              global const double* predicted, global const double* mass,
                              global const int* body_of, global const Body* bodies,
                              global const Gas* gases, global double2* volume_and_pressure,
                              global double4* sorted_velocity) {
  const int own_slot = get_global_id(0);
  if (own_slot >= p.count) return;
  const int i = order[own_slot];
  if (i >= p.liquids) return;
  const int material = bodies[body_of[i]].material;
  const Gas gas = gases[material];
  const double support = gas.support;
  const double3 at = sorted_at(&p, sorted, own_slot);
  double sum = mass[i] * (support * support * support * support * support * support);
  FOR_EACH_GAS_NEIGHBOUR({
    const double rest = support * support - square;
    sum += mass[j] * (rest * rest * rest);
  })
  const double density = gas.density_scale * sum;
  volume_and_pressure[own_slot] =
      (double2)(mass[i] / density, gas.stiffness * fmax(0.0, density - gas.rest_density));
  const double filling = filling_beyond_walls(&p, step.no_slip, support, at);
  sorted_velocity[own_slot] = (double4)(vector_at(predicted, i),
                                        density / (density + gas.rest_density * filling));
}

// Adds the forces of pressure, viscosity, no-slip walls and settling.
kernel void add_gas_forces(const Solids p, const GasStep step, global const int* begins,
                           global const int* order, global const double* sorted,
                           global const double2* volume_and_pressure,
                           global const double4* sorted_velocity, global const double* mass,
                           global const int* body_of, global const Body* bodies,
                           global const Gas* gases, global double* force) {
  const int own_slot = get_global_id(0);
  if (own_slot >= p.count) return;
  const int i = order[own_slot];
  if (i >= p.liquids) return;
  const int material = bodies[body_of[i]].material;
  const Gas gas = gases[material];
  const double support = gas.support;
  const double3 at = sorted_at(&p, sorted, own_slot);
  const double3 v = sorted_velocity[own_slot].xyz;
  const double filled = sorted_velocity[own_slot].w;
  const double2 own = volume_and_pressure[own_slot];
  double3 sum = 0;
  FOR_EACH_GAS_NEIGHBOUR({
    const double r = sqrt(square);
    const double rest = support - r;
    const double2 other = volume_and_pressure[slot];
    const double push = (own.y + other.y) * gas.pressure_slope * (rest * rest);
    const double3 relative = sorted_velocity[slot].xyz - v;
    const double viscosity = gas.viscosity * rest * (filled * sorted_velocity[slot].w);
    sum += other.x * (push * direction_of(&p, way, r, i, j) + viscosity * relative);
  })
  const double3 still = (double3)(step.still[0], step.still[1], step.still[2]);
  const double3 of_walls = drag_of_walls(&p, step.no_slip, support,
                                         gas.wall_viscosity * (own.x * filled), at, v);
  const double3 own_force = own.x * sum + of_walls - (mass[i] * step.drag) * (v - still);
  store_vector(vector_at(force, i) + own_force, force, i);
}
