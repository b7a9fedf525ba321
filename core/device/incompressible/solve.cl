// Solves over the particles of an incompressible liquid, for pressures times dt^2. The names are
// those of core/liquid/incompressible/complementarity.h and pressure_response.h. All vectors are by
// slot. Those of unknowns have zeros for solids. The part of moving solids is in solids.cl.

typedef struct {
  double wall_velocity[3];
  double gravity[3];
  double dt;
  double volume;
  double rate_factor;
  double acceleration_factor;
  double diagonal_factor;
  double mean;
  double greatest;
  double start_mean;
  double start_greatest;
  double first_reduction;
  double later_reduction;
  double negligible;
  double least_bound;
  double greatest_bound;
  double bound_of_optimal;
  double closing;
  double left_alone;
  double removal;
  double max_expansion;
  double push_factor;
  double slope_scale;
  int most_iterations;
  int count;
  int slots;
  int free;
  int solids_move;
} Solve;

// `share`, `slope`, `length` and `is_last` belong to the current iteration. `is_last` states whether
// its expected residuals are within the limits.
typedef struct {
  double mean;
  double greatest;
  double mean_excess;
  double greatest_excess;
  double square;
  double share;
  double slope;
  double length;
  double longest_step;
  int iterations;
  int is_open;
  int restarts;
  int is_last;
} Progress;

// The diagonal, or 0 for a particle without neighbours.
double diagonal_of(const Solve* solve, float weight, float squares) {
  return solve->dt * solve->dt * solve->diagonal_factor * (double)weight * (double)squares;
}

// Computes the gradient of an unknown. Returns its part of the sums: residual, g.D g_last and
// g.D g, and its greatest residual.
double4 find_gradient(const Solve* solve, double x, double excess, double diagonal, double scale,
                      double last, double* gradient) {
  const double e = greater(excess, -x * diagonal);
  const double residual = fabs(e) / scale;
  const bool pushes = x * diagonal > solve->negligible * scale;
  *gradient = e / diagonal;
  return (double4)(residual, e * last, e * *gradient, pushes ? fabs(excess) / scale : residual);
}

// Begins a solve with the initial unknown and excess of a particle. The scale of a solid is 0.
double4 begin(const Solve* solve, int slot, double first, double excess, double diagonal,
              double scale, global double* x, global double* excesses, global double* gradient,
              global float4* whole) {
  double g = 0;
  double4 sums = 0;
  if (scale > 0) sums = find_gradient(solve, first, excess, diagonal, scale, 0, &g);
  x[slot] = first;
  excesses[slot] = excess;
  gradient[slot] = g;
  whole[slot] = 0;
  return sums;
}

// The diagonal of a particle without neighbours.
#define ALONE 1.0

kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void begin_projection(
    const Parameters p, const Solve solve, global const int* begins, global const int* order,
    global const int4* sorted_place, global const int* counts, global const int* plain_counts,
    global const uint* lists, global const float4* solve_motion,
    global const float* density, global const float* squares, global const double* pressure,
    global double* x, global double* excess, global double* gradient, global float4* whole,
    global double4* partial) {
  local double4 sums[GROUP];
  const int start = LANES * get_global_id(0);
  float rates[LANES];
  if (start < solve.slots) {
    find_rates(&p, start, begins, sorted_place, counts, plain_counts, lists, solve_motion,
               rates);
  }
  for (int lane = 0; lane < LANES; ++lane) {
    const int slot = start + lane;
    double4 own = 0;
    if (slot < solve.slots) {
      double scale = 0;
      double first = 0;
      double e = 0;
      double diagonal = ALONE;
      if (!is_solid(sorted_place[slot])) {
        const float weight = weight_of(sorted_place[slot]);
        scale = solve.volume * (double)weight;
        const double s = density[slot];
        const double over = s - 1 - solve.left_alone;
        const double removed = over < 0 ? 0 : over > solve.removal ? solve.removal : over;
        const double room = s < 1 ? solve.closing * (1 - s) : -removed;
        e = scale * (solve.dt * solve.rate_factor * (double)rates[lane] - room);
        const double bound = diagonal_of(&solve, weight, squares[slot]);
        if (bound > 0) {
          diagonal = bound;
          first = pressure[order[slot]] / (s * s);
        } else if (e > 0) {
          e = 0;
        }
      }
      own = begin(&solve, slot, first, e, diagonal, scale, x, excess, gradient, whole);
    }
    sums[LANES * get_local_id(0) + lane] = own;
  }
  write_partial_of_lanes(sums, partial);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void begin_shift(
    const Solve solve, global const int4* sorted_place, global const float* density,
    global const float* squares, global double* x, global double* excess,
    global double* gradient, global float4* whole, global double4* partial) {
  local double4 sums[GROUP];
  const int slot = get_global_id(0);
  double4 own = 0;
  if (slot < solve.slots) {
    double scale = 0;
    double e = 0;
    double diagonal = ALONE;
    if (!is_solid(sorted_place[slot])) {
      const float weight = weight_of(sorted_place[slot]);
      scale = solve.volume * (double)weight;
      const double over = (double)density[slot] - 1;
      e = scale * (solve.max_expansion < over ? solve.max_expansion : over);
      const double bound = diagonal_of(&solve, weight, squares[slot]);
      if (bound > 0) diagonal = bound;
    }
    own = begin(&solve, slot, 0, e, diagonal, scale, x, excess, gradient, whole);
  }
  write_partial(sums, own, partial);
}

// Sets the direction d to g + share d, or to g if `is_restart` is set. Shortens d so that
// x + longest_step d >= 0. `charge` is d in single precision.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void follow(
    const int slots, const int is_restart, global const Progress* progress,
    global const double* x, global const double* excess, global const double* gradient,
    global double* direction, global Charge* charge, global double4* partial) {
  local double4 sums[GROUP];
  if (!progress->is_open || (is_restart && !progress->restarts)) return;
  const int slot = get_global_id(0);
  double4 own = 0;
  if (slot < slots) {
    const double share = is_restart ? 0 : progress->share;
    double d = gradient[slot];
    if (share > 0) d += share * direction[slot];
    d = greater(d, -x[slot] / progress->longest_step);
    direction[slot] = d;
    charge[slot] = CHARGE((float)d);
    own.x = d * excess[slot];
  }
  write_partial(sums, own, partial);
}

// Sums the slope of the direction. A direction that is not one of descent is replaced.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_slope(
    const int groups, const int is_restart, global const double4* partial,
    global Progress* progress) {
  local double4 sums[GROUP];
  const bool is_needed = progress->is_open && (!is_restart || progress->restarts);
  if (!is_needed) return;
  const double4 total = sum_partial(sums, groups, partial);
  if (get_local_id(0) != 0) return;
  progress->slope = total.x;
  progress->restarts = !is_restart && !(total.x > 0) && progress->share > 0;
}

// Sets the motion to the accelerations by the charges. If solids move, `push` receives the forces on
// their particles, and free particles are accelerated. Sums the curvature along the direction, see
// PressureResponse::energy().
kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void accelerate(
    const Parameters p, const Solve solve, global const Progress* progress,
    global const int* begins, global const int* order, global const int4* sorted_place,
    global const int* counts, global const int* plain_counts, global const uint* lists,
    global const Charge* charge, global const double* mobility, global double* push,
    global float4* solve_motion, global double4* partial) {
  local double4 sums[GROUP];
  if (!progress->is_open) return;
  const int first = LANES * get_global_id(0);
  float3 pushes[LANES];
  if (first < solve.slots) {
    find_pushes(&p, solve.solids_move, first, begins, sorted_place, counts, plain_counts, lists,
                charge, pushes);
  }
  for (int lane = 0; lane < LANES; ++lane) {
    const int slot = first + lane;
    double4 own = 0;
    if (slot < solve.slots) {
      float3 a = 0;
      if (!is_solid(sorted_place[slot])) {
        a = -(float)solve.acceleration_factor * pushes[lane];
        const double x = a.x;
        const double y = a.y;
        const double z = a.z;
        const double inertia = solve.volume * (double)weight_of(sorted_place[slot]) *
                               solve.rate_factor / solve.acceleration_factor;
        own.x = solve.dt * solve.dt * inertia * (x * x + y * y + z * z);
      } else if (solve.solids_move) {
        const int b = order[slot] - solve.count;
        const double factor = solve.push_factor * (double)weight_of(sorted_place[slot]);
        const double3 force = factor * convert_double3(pushes[lane]);
        vstore3(force, b, push);
        if (b < solve.free) {
          const double square = force.x * force.x + force.y * force.y + force.z * force.z;
          a = convert_float3(mobility[b] * force);
          own.x = solve.dt * solve.dt * mobility[b] * square / solve.slope_scale;
        }
      }
      solve_motion[slot] = (float4)(a, 0);
    }
    sums[LANES * get_local_id(0) + lane] = own;
  }
  write_partial_of_lanes(sums, partial);
}

// Computes the product of the matrix and the direction from the accelerations.
kernel void compress(const Parameters p, const Solve solve, global const Progress* progress,
                     global const int* begins, global const int4* sorted_place,
                     global const int* counts, global const int* plain_counts,
                     global const uint* lists,
                     global const float4* solve_motion, global double* product) {
  const int first = LANES * get_global_id(0);
  if (first >= solve.slots || !progress->is_open || progress->is_last) return;
  float rates[LANES];
  find_rates(&p, first, begins, sorted_place, counts, plain_counts, lists,
             solve_motion, rates);
  for (int lane = 0; lane < LANES && first + lane < solve.slots; ++lane) {
    const int slot = first + lane;
    if (is_solid(sorted_place[slot])) continue;
    const double scale = solve.volume * (double)weight_of(sorted_place[slot]);
    product[slot] = -solve.dt * solve.dt * solve.rate_factor * scale * (double)rates[lane];
  }
}

// Chooses the length of the step to the minimum along the direction, and decides whether the
// iteration is the last.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_length(
    const Solve solve, const int groups, global const double4* partial,
    global Progress* progress) {
  local double4 sums[GROUP];
  if (!progress->is_open) return;
  const double curvature = sum_partial(sums, groups, partial).x;
  if (get_local_id(0) != 0) return;
  const double optimal = curvature > 0 ? progress->slope / curvature : 0;
  const double longest = progress->longest_step;
  progress->length = longest < optimal ? longest : optimal;
  const double next = solve.bound_of_optimal * optimal;
  progress->longest_step = next < solve.least_bound      ? solve.least_bound
                           : next > solve.greatest_bound ? solve.greatest_bound
                                                         : next;
  const double reduction =
      progress->iterations == 0 ? solve.first_reduction : solve.later_reduction;
  progress->is_last = progress->mean * reduction <= solve.mean &&
                      progress->greatest * reduction <= solve.greatest;
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void take_step(
    const Solve solve, global const Progress* progress, global const int4* sorted_place,
    global const float* squares, global const double* direction, global const double* product,
    global const float4* solve_motion, global double* x, global double* excess,
    global double* gradient, global float4* whole, global double4* partial) {
  local double4 sums[GROUP];
  if (!progress->is_open) return;
  const int slot = get_global_id(0);
  double4 own = 0;
  if (slot < solve.slots && !is_solid(sorted_place[slot])) {
    const double length = progress->length;
    double next = x[slot];
    double e = excess[slot];
    if (length > 0) {
      next += length * direction[slot];
      if (next < 0) next = 0;  // by rounding
      if (!progress->is_last) e -= length * product[slot];
      whole[slot] += (float)length * solve_motion[slot];
    }
    const float weight = weight_of(sorted_place[slot]);
    const double diagonal = diagonal_of(&solve, weight, squares[slot]);
    double g;
    own = find_gradient(&solve, next, e, diagonal > 0 ? diagonal : ALONE,
                        solve.volume * (double)weight, gradient[slot], &g);
    x[slot] = next;
    excess[slot] = e;
    gradient[slot] = g;
  }
  write_partial(sums, own, partial);
}

// Ends an iteration, or begins a solve if `is_start` is set, and decides whether another iteration
// follows. The residuals of the last iteration are the expected ones.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void end_iteration(
    const Solve solve, const int groups, const int is_start, global const double4* partial,
    global Progress* progress) {
  local double4 sums[GROUP];
  const bool is_needed = is_start || progress->is_open;
  if (!is_needed) return;
  const double4 total = sum_partial(sums, groups, partial);
  if (get_local_id(0) != 0) return;
  const double last = progress->square;
  const double mean = total.x / (double)solve.count;
  progress->share = is_start || !(last > 0) ? 0 : greater(0, (total.z - total.y) / last);
  progress->square = total.z;
  const double reduction =
      progress->iterations == 0 ? solve.first_reduction : solve.later_reduction;
  const bool is_last = !is_start && progress->is_last;
  progress->mean = is_last ? progress->mean * reduction : mean;
  progress->greatest = is_last ? progress->greatest * reduction : total.w;
  if (is_start) progress->longest_step = solve.least_bound;
  progress->iterations = is_start ? 0 : progress->iterations + 1;
  const bool is_far = !isnan(mean) && (mean > solve.mean || total.w > solve.greatest);
  const bool must_begin = is_start && (mean > solve.start_mean || total.w > solve.start_greatest);
  progress->is_open =
      !is_last && (is_far || must_begin) && progress->iterations < solve.most_iterations;
}

// Sets the excess of the density to the sums of find_density.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void measure_excess(
    const int count, const int groups, global const double4* partial, global Progress* progress) {
  local double4 sums[GROUP];
  const double4 total = sum_partial(sums, groups, partial);
  if (get_local_id(0) != 0) return;
  progress->mean_excess = total.x / (double)count;
  progress->greatest_excess = total.w;
}
