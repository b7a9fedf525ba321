// The limit of the elongation of springs, see core/solid/elongation_limit.h. One group of work-items
// computes all springs, one colour after the other.

typedef struct {
  double greatest;  // length [m]
  uint a;
  uint b;
  uint end;
  uint padding;
} LimitedSpring;

// The present state of a limited spring, see ElongationScratch::Limit.
typedef struct {
  double direction[3];
  double free_speed;
  double mass;
  double impulse;
  double gradient;
  double search;
} ElongationLimit;

void begin_limit(const LimitedSpring* spring, double dt, int is_torn, global const double* position,
                 global const double* mobility, global ElongationLimit* limit) {
  const double3 x = vector_at(position, spring->a) - vector_at(position, spring->b);
  const double length = sqrt(product(x, x));
  const bool acts = !is_torn && length > 0;
  const double3 direction = acts ? x / length : (double3)(0);
  store_vector(direction, limit->direction, 0);
  limit->free_speed = (spring->greatest - length) / dt;
  limit->mass = acts ? 1 / (mobility[spring->a] + mobility[spring->b]) : 0;
  limit->impulse = 0;
  limit->gradient = 0;
  limit->search = 0;
}

// Changes the impulse of a spring, and the velocities of its ends.
void pull_ends(const LimitedSpring* spring, double change, global const double* mobility,
               global double* velocity, global ElongationLimit* limit) {
  const double3 direction = vector_at(limit->direction, 0);
  const double3 of_a = vector_at(velocity, spring->a) - (mobility[spring->a] * change) * direction;
  const double3 of_b = vector_at(velocity, spring->b) + (mobility[spring->b] * change) * direction;
  store_vector(of_a, velocity, spring->a);
  store_vector(of_b, velocity, spring->b);
  limit->impulse += change;
}

// Changes the impulse of a spring so that it reaches its limit, or is free. Returns whether the change
// exceeds the tolerance.
bool relax_limit(const LimitedSpring* spring, double dt, double tolerance,
                 global const double* mobility, global double* velocity,
                 global ElongationLimit* limit) {
  const double3 apart = vector_at(velocity, spring->a) - vector_at(velocity, spring->b);
  const double excess = product(apart, vector_at(limit->direction, 0)) - limit->free_speed;
  const double change = fmax(-limit->impulse, limit->mass * excess);
  if (limit->mass == 0 || change == 0) return false;
  pull_ends(spring, change, mobility, velocity, limit);
  return fabs(change) * dt > tolerance * spring->greatest * limit->mass;
}

// Changes the velocities for a drift of `dt`. The springs are in the order of `colours`, whose begins are
// `begins`. Adds the number of sweeps to `sweeps_of_steps`. Runs with one group.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void limit_elongation(
    const int colours, const double dt, const double tolerance, const int most_sweeps,
    const int springs_change, global const uint* begins, global const LimitedSpring* springs,
    global const int* are_torn, global const double* position, global const double* mobility,
    global double* velocity, global ElongationLimit* limits, global ulong* sweeps_of_steps) {
  local double4 sums[GROUP];
  const uint t = get_local_id(0);
  const uint count = begins[colours];
  for (uint k = t; k < count; k += GROUP) {
    const LimitedSpring spring = springs[k];
    begin_limit(&spring, dt, springs_change && are_torn[spring.end], position, mobility,
                limits + k);
  }
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  bool is_open = true;
  double last = 0;
  int sweeps = 0;
  while (is_open) {
    sweeps += 2;
    for (uint k = t; k < count; k += GROUP) limits[k].gradient = -limits[k].impulse;
    double4 own = 0;
    for (int pass = 0; pass < 2 * colours; ++pass) {
      const int colour = pass < colours ? pass : 2 * colours - 1 - pass;
      for (uint k = begins[colour] + t; k < begins[colour + 1]; k += GROUP) {
        const LimitedSpring spring = springs[k];
        if (relax_limit(&spring, dt, tolerance, mobility, velocity, limits + k)) own.y = 1;
      }
      barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    }
    for (uint k = t; k < count; k += GROUP) {
      const double gradient = limits[k].gradient + limits[k].impulse;
      limits[k].gradient = gradient;
      own.x += gradient * gradient;
    }
    const double4 total = sum_group(sums, own);
    is_open = total.y > 0 && sweeps < most_sweeps;
    const double share = total.x < last ? total.x / last : 0;
    last = total.x;
    const int extrapolated = is_open ? colours : 0;
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (int colour = 0; colour < extrapolated; ++colour) {
      for (uint k = begins[colour] + t; k < begins[colour + 1]; k += GROUP) {
        const LimitedSpring spring = springs[k];
        const double change = share * limits[k].search;
        limits[k].search = change + limits[k].gradient;
        if (change != 0) pull_ends(&spring, change, mobility, velocity, limits + k);
      }
      barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    }
  }
  if (t == 0) *sweeps_of_steps += sweeps;
}
