// A step of an incompressible liquid; see core/liquid/incompressible/volume_solve.h. The solves are
// in solve.cl.

// Enters the particles into their cells. If `is_held` is true, the particles drift first, and those
// beyond a wall are moved back.
kernel void place(const Parameters p, const int is_held, global double* position,
                  global double* velocity, global const float* weight, global int4* place,
                  global float4* motion, global int* cell_of, global int* rank,
                  global int* cell_counts, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  double x[3];
  double v[3];
  for (int k = 0; k < 3; ++k) {
    v[k] = velocity[3 * i + k];
    x[k] = position[3 * i + k] + p.drift * v[k];
  }
  if (is_held) {
    if (reflect_at_walls(&p, x, v)) atomic_inc(status + kStops);
    for (int k = 0; k < 3; ++k) {
      position[3 * i + k] = x[k];
      velocity[3 * i + k] = v[k];
    }
  }
  const float w[3] = {(float)v[0], (float)v[1], (float)v[2]};
  enter_cell(&p, i, x, w, weight, place, motion, cell_of, rank, cell_counts, status);
}

// Checks the state at the end of a step.
kernel void check(const Parameters p, global const double* position,
                  global const double* velocity, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  double x[3];
  double v[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = position[3 * i + k];
    v[k] = velocity[3 * i + k];
  }
  if (!is_sound(&p, x, v)) atomic_or(status + kFault, 1);
}

// Lists the neighbours of each particle, and computes its relative density s. Computes the squares
// |sum_j a_j g x|^2 + a sum_j a_j g^2 q^2, with the names of PairSums. Solids count twice in the first
// sum, and not in the second one. Sets the fourth component of sorted_motion to pressure / s^2. `partial` receives the sum and the maximum of the density above
// the rest density.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_density(
    const Parameters p, global const int* begins, global const int* order,
    global const double* pressure, global const int4* sorted_place, global float4* sorted_motion,
    global int* counts, global uint* lists, global float* density, global float* squares,
    global double4* partial) {
  local double4 sums[GROUP];
  const int slot = get_global_id(0);
  double4 excess = 0;
  if (slot < p.count + p.solids) {
    const int4 own = sorted_place[slot];
    const int n[3] = {own.x, own.y, own.z};
    float sum = 0;
    float3 gradient = 0;
    float square_sum = 0;
    int count = 0;
    FOR_EACH_CANDIDATE(&p, n, begins, {
      const int4 other = sorted_place[j];
      const float3 x = way_to(&p, at, other);
      const float square = square_of(x);
      if (!(square < 1)) continue;
      const float q = sqrt(square);
      const float slope = kernel_slope(q);
      const float share = weight_of(other) * slope;
      sum += weight_of(other) * kernel_value(q);
      if (is_solid(other)) {
        gradient += 2 * share * turned(&p, code, x);
      } else {
        gradient += share * turned(&p, code, x);
        square_sum += share * slope * square;
      }
      list(lists, slot, &count, j, code);
    })
    counts[slot] = count;
    if (!is_solid(own)) {
      const float weight = weight_of(own);
      if (sum > 1) sum -= own_excess(&p, n, weight);
      density[slot] = sum;
      squares[slot] = square_of(gradient) + weight * square_sum;
      const double s = sum;
      sorted_motion[slot].w = (float)(pressure[order[slot]] / (s * s));
      excess.x = greater(0, s - 1);
      excess.w = excess.x;
    }
  }
  write_partial(sums, excess, partial);
}

// Changes the velocities by the forces over solve.dt. The gravity is solve.gravity in place of
// p.gravity, because it is not rounded to single precision. Sets solve_motion to the velocities relative
// to the walls.
kernel void kick(const Parameters p, const Solve solve, global const int* begins,
                 global const int* order, global const int4* sorted_place,
                 global const float4* sorted_motion, global const int* counts,
                 global const uint* lists, global double* velocity, global float4* solve_motion) {
  const int slot = get_global_id(0);
  if (slot >= solve.slots) return;
  if (is_solid(sorted_place[slot])) {
    const float v[3] = {-(float)solve.wall_velocity[0], -(float)solve.wall_velocity[1],
                        -(float)solve.wall_velocity[2]};
    solve_motion[slot] = (float4)(v[0], v[1], v[2], 0);
    return;
  }
  const float3 a = acceleration_of(&p, slot, begins, sorted_place, sorted_motion, counts, lists);
  const float by[3] = {a.x, a.y, a.z};
  const int i = order[slot];
  float w[3];
  for (int k = 0; k < 3; ++k) {
    const double v = velocity[3 * i + k] + solve.dt * (solve.gravity[k] + (double)by[k]);
    velocity[3 * i + k] = v;
    w[k] = (float)(v - solve.wall_velocity[k]);
  }
  solve_motion[slot] = (float4)(w[0], w[1], w[2], 0);
}

// Ends the solve of the velocities.
kernel void end_projection(const Solve solve, global const Progress* progress,
                           global const int* order, global const float* density,
                           global const double* x, global const float4* whole,
                           global double* pressure, global double* velocity) {
  const int slot = get_global_id(0);
  if (slot >= solve.slots || progress->iterations == 0) return;
  const int i = order[slot];
  if (i >= solve.count) return;
  const double s = density[slot];
  pressure[i] = x[slot] * s * s;
  const float4 a = whole[slot];
  const float by[3] = {a.x, a.y, a.z};
  for (int k = 0; k < 3; ++k) velocity[3 * i + k] += solve.dt * (double)by[k];
}

// Ends the solve of the positions.
kernel void shift_places(const Solve solve, global const int* order,
                         global const float4* whole, global double* position) {
  const int slot = get_global_id(0);
  if (slot >= solve.slots) return;
  const int i = order[slot];
  if (i >= solve.count) return;
  const float4 a = whole[slot];
  const float by[3] = {a.x, a.y, a.z};
  for (int k = 0; k < 3; ++k) position[3 * i + k] += solve.dt * solve.dt * (double)by[k];
}
