// Moving solids in a solve for the velocities of an incompressible liquid, see PressureResponse.
// `push` has the forces by the charges on the particles, and then the force and the torque on each
// rigid body. `total` has the sums of these forces over the iterations, for free particles and bodies.
// Particles are counted from the first solid particle.

// Sets the motions of solids to their velocities relative to the walls. The fourth component receives
// the root of the mobility, see PressureResponse::mobility_of(). As on the CPU, the velocities of free
// particles include the kick by the forces, and those of particles of rigid bodies do not.
kernel void see_solids(const Solve solve, global const int* order, global const int4* sorted_place,
                       global const double* velocity, global const double* predicted,
                       global const float* roots, global float4* solve_motion) {
  const int slot = get_global_id(0);
  if (slot >= solve.slots || !is_solid(sorted_place[slot])) return;
  const int b = order[slot] - solve.count;
  const double3 v = vector_at(b < solve.free ? velocity : predicted, b) - three(solve.wall_velocity);
  solve_motion[slot] = (float4)(convert_float3(v), roots[b]);
}

// The sum of the roots of the mobilities of solids around a liquid particle, each times twice its
// weight and the length of its gradient.
float mobility_around(const Parameters* p, int slot, global const int* begins,
                      global const int4* sorted_place, global const int* counts,
                      global const uint* lists, global const float4* solve_motion) {
  const int4 own = sorted_place[slot];
  const int n[3] = {own.x, own.y, own.z};
  float sum = 0;
  FOR_EACH_NEIGHBOUR(p, slot, n, begins, counts, lists, {
    const int4 other = sorted_place[j];
    if (!is_solid(other)) continue;
    const float square = square_of(way_from(p, code, n, other));
    if (!(square < 1)) continue;
    const float q = sqrt(square);
    sum += 2 * weight_of(other) * solve_motion[j].w * (kernel_slope(q) * q);
  })
  return sum;
}

#if LANES > 1
// Finds the results of mobility_around() for LANES slots from `first` on, except of solids.
void find_mobilities(const Parameters* p, int first, global const int* begins,
                     global const int4* sorted_place, global const int* counts,
                     global const int* plain_counts, global const uint* lists,
                     global const float4* solve_motion, float* mobilities) {
  global const float4* places = (global const float4*)sorted_place;
  const Columns own = columns_at(places, first);
  float16 sum = 0;
  FOR_EACH_LISTED(p, first, counts, plain_counts, lists, {
    const Columns source = gather(places, offsets);
    const int16 counts_here = is_listed & (source.w < 0);
    if (!any(counts_here)) continue;
    const float16 root = gather(solve_motion, offsets).w;
    const float16 q = sqrt(ways_from(p, listed, has_images, own, source).square);
    sum += select(0.0f, 2 * fabs(source.w) * root * (kernel_slopes(q) * q), counts_here);
  })
  vstore16(sum, 0, mobilities);
  for (int lane = 0; lane < LANES && first + lane < p->count + p->solids; ++lane) {
    if (counts[first + lane] <= p->list_length || is_solid(sorted_place[first + lane])) continue;
    mobilities[lane] =
        mobility_around(p, first + lane, begins, sorted_place, counts, lists, solve_motion);
  }
}
#else
void find_mobilities(const Parameters* p, int first, global const int* begins,
                     global const int4* sorted_place, global const int* counts,
                     global const int* plain_counts, global const uint* lists,
                     global const float4* solve_motion, float* mobilities) {
  if (is_solid(sorted_place[first])) return;
  mobilities[0] = mobility_around(p, first, begins, sorted_place, counts, lists, solve_motion);
}
#endif

// Adds the part of the solids to the squares of find_density, see PressureResponse::find_slopes().
kernel void add_mobility_of_solids(const Parameters p, const Solve solve, global const int* begins,
                                   global const int4* sorted_place, global const int* counts,
                                   global const int* plain_counts, global const uint* lists,
                                   global const float4* solve_motion, global float* squares) {
  const int first = LANES * get_global_id(0);
  if (first >= solve.slots) return;
  float mobilities[LANES];
  find_mobilities(&p, first, begins, sorted_place, counts, plain_counts, lists, solve_motion,
                  mobilities);
  for (int lane = 0; lane < LANES && first + lane < solve.slots; ++lane) {
    const int slot = first + lane;
    if (is_solid(sorted_place[slot])) continue;
    const float square = mobilities[lane] * mobilities[lane];
    squares[slot] += weight_of(sorted_place[slot]) * (p.density * (float)solve.volume) * square;
  }
}

// Sums the forces on each rigid body, and finds its linear and angular acceleration. Adds its part of
// the curvature. One group for each body.
kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void accelerate_of_bodies(
    const Solve solve, const int first, const int groups, global const Progress* progress,
    global const Rigid* rigid, global const Pose* poses, global const double* position,
    global double* push, global double* acceleration, global double4* partial) {
  local double4 sums[GROUP];
  local double4 torques[GROUP];
  if (!progress->is_open) return;
  const int b = get_group_id(0);
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const Resultant all = resultant_of(sums, torques, &body, three(pose.center), position, push, 0, 0);
  if (get_local_id(0) != 0) return;
  const double3 force = body.is_held ? (double3)(0) : all.force;
  const double3 torque = body.is_held ? (double3)(0) : all.torque;
  const double3 linear = body.inverse_mass * force;
  const double3 angular = spin_of(&body, orientation_of(&pose), torque);
  store_vector(force, push, first + 2 * b);
  store_vector(torque, push, first + 2 * b + 1);
  store_vector(linear, acceleration, 2 * b);
  store_vector(angular, acceleration, 2 * b + 1);
  const double energy = (product(force, linear) + product(torque, angular)) / solve.slope_scale;
  partial[groups + b] = (double4)(solve.dt * solve.dt * energy, 0, 0, 0);
}

// Sets the motions of the particles of rigid bodies to their accelerations.
kernel void accelerate_rigid_particles(const Solve solve, global const Progress* progress,
                                       global const int* order, global const int4* sorted_place,
                                       global const int* rigid_of, global const Pose* poses,
                                       global const double* position,
                                       global const double* acceleration,
                                       global float4* solve_motion) {
  const int slot = get_global_id(0);
  if (slot >= solve.slots || !progress->is_open || !is_solid(sorted_place[slot])) return;
  const int e = order[slot] - solve.count;
  if (e < solve.free) return;
  const int b = rigid_of[e - solve.free];
  const Pose pose = poses[b];
  const double3 arm = vector_at(position, e) - three(pose.center);
  const double3 a =
      vector_at(acceleration, 2 * b) + cross_product(vector_at(acceleration, 2 * b + 1), arm);
  solve_motion[slot] = (float4)(convert_float3(a), 0);
}

// Adds the forces times the length of the step of an iteration.
kernel void add_pushes(const Solve solve, const int particles, const int bodies,
                       global const Progress* progress, global const double* push,
                       global double* total) {
  const int n = get_global_id(0);
  if (n >= solve.free + 2 * bodies || !progress->is_open) return;
  const int from = n < solve.free ? n : particles + n - solve.free;
  store_vector(vector_at(total, n) + progress->length * vector_at(push, from), total, n);
}

// Ends the solve: kicks free particles and bodies by the total forces.
kernel void kick_by_pushes(const Solve solve, const int bodies, global const Progress* progress,
                           global const double* mobility, global const double* total,
                           global double* velocity, global Pose* poses) {
  const int n = get_global_id(0);
  if (n >= solve.free + bodies || progress->iterations == 0) return;
  if (n < solve.free) {
    const double3 change = (solve.dt * mobility[n]) * vector_at(total, n);
    store_vector(vector_at(velocity, n) + change, velocity, n);
    return;
  }
  const int b = n - solve.free;
  for (int k = 0; k < 3; ++k) {
    poses[b].momentum[k] += solve.dt * total[3 * (solve.free + 2 * b) + k];
    poses[b].angular_momentum[k] += solve.dt * total[3 * (solve.free + 2 * b + 1) + k];
  }
}
