// The part of rigid bodies in the solve of damping.cl. Each vector has the entries of all particles,
// and then a linear and an angular entry for each rigid body.

// Changes of the velocity of a body for a unit of time.
double3 by_mass(const Rigid* body, double3 force) {
  return body->is_held ? (double3)(0) : body->inverse_mass * force;
}
double3 by_inertia(const Rigid* body, const Pose* pose, double3 torque) {
  return body->is_held ? (double3)(0)
                       : times_in_body(body->inverse_inertia, orientation_of(pose), torque);
}

// The vectors of a solve.
kernel void begin_damping_of_bodies(const Damping damping, const int count, const int first,
                                    const int groups, global const Rigid* rigid,
                                    global const Pose* poses, global const double* rigid_force,
                                    global double* change, global double* change_of_force,
                                    global double* residual, global double* direction,
                                    global double4* partial, global double4* momenta) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const int at = first + 2 * b;
  const double3 linear = damping.dt * vector_at(rigid_force, 2 * b);
  const double3 angular = damping.dt * vector_at(rigid_force, 2 * b + 1);
  const double3 along = by_mass(&body, linear);
  const double3 about = by_inertia(&body, &pose, angular);
  for (int k = 0; k < 2; ++k) {
    store_vector((double3)(0), change, at + k);
    store_vector((double3)(0), change_of_force, at + k);
  }
  store_vector(linear, residual, at);
  store_vector(angular, residual, at + 1);
  store_vector(along, direction, at);
  store_vector(about, direction, at + 1);
  const double3 p = three(pose.momentum);
  const double square = body.is_held ? 0 : body.inverse_mass * product(p, p);
  partial[groups + b] =
      (double4)(product(linear, along) + product(angular, about), square, 0, 0);
  momenta[groups + b] = body.is_held ? (double4)(0) : (double4)(p, 0);
}

kernel void turn_damping_of_bodies(const int count, const int first,
                                   global const DampingProgress* progress,
                                   global const Rigid* rigid, global const Pose* poses,
                                   global const double* residual, global double* direction,
                                   global double* spins) {
  const int b = get_global_id(0);
  if (b >= count || !progress->is_open) return;
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const int at = first + 2 * b;
  const double share = progress->share;
  const double3 linear =
      by_mass(&body, vector_at(residual, at)) + share * vector_at(direction, at);
  const double3 angular =
      by_inertia(&body, &pose, vector_at(residual, at + 1)) + share * vector_at(direction, at + 1);
  store_vector(linear, direction, at);
  store_vector(angular, direction, at + 1);
  store_vector(angular, spins, body.body);
}

// Sets the entries of the particles of rigid bodies in the direction. Contacts are mutual, so that
// particles without acting contacts need none. This holds up to rounding across the sides of a
// periodic world.
kernel void pose_damping(const Solids p, global const DampingProgress* progress,
                         global const int* rigid_of, global const Pose* poses,
                         global const double* position, global const int* contact_counts,
                         global double* direction) {
  const int e = p.free + get_global_id(0);
  if (e >= p.count || !progress->is_open) return;
  const bool is_periodic = p.period[0] > 0 || p.period[1] > 0 || p.period[2] > 0;
  if (contact_counts[e] == 0 && !is_periodic) return;
  const int b = rigid_of[e - p.free];
  const Pose pose = poses[b];
  const int at = p.count + 2 * b;
  const double3 arm = vector_at(position, e) - three(pose.center);
  store_vector(vector_at(direction, at) + cross_product(vector_at(direction, at + 1), arm),
               direction, e);
}

// Sums the products of the particles of each body. One group for each body.
kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void multiply_damping_of_bodies(
    const Damping damping, const int first, const int groups, global const Rigid* rigid,
    global const Pose* poses, global const double* position, global const double* torque,
    global const double* direction, global const int* contact_counts, global double* multiplied,
    global double4* partial) {
  local double4 forces[GROUP];
  local double4 torques[GROUP];
  const int b = get_group_id(0);
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const int at = first + 2 * b;
  const Resultant q =
      resultant_of(forces, torques, &body, three(pose.center), position, multiplied, torque,
                   contact_counts);
  if (get_local_id(0) != 0) return;
  store_vector(q.force, multiplied, at);
  store_vector(q.torque, multiplied, at + 1);
  const double3 linear = vector_at(direction, at);
  const double3 angular = vector_at(direction, at + 1);
  const double3 spun = times_in_body(body.inertia, orientation_of(&pose), angular);
  const double curvature = product(linear, body.mass * linear - damping.dt * q.force) +
                           product(angular, spun - damping.dt * q.torque);
  partial[groups + b] = (double4)(curvature, 0, 0, 0);
}

kernel void advance_damping_of_bodies(const Damping damping, const int count, const int first,
                                      const int groups, global const DampingProgress* progress,
                                      global const Rigid* rigid, global const Pose* poses,
                                      global const double* direction,
                                      global const double* multiplied, global double* change,
                                      global double* change_of_force, global double* residual,
                                      global double4* partial) {
  const int b = get_global_id(0);
  if (b >= count || !progress->is_open) return;
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const int at = first + 2 * b;
  const double length = progress->length;
  double3 w[2];
  double3 r[2];
  for (int k = 0; k < 2; ++k) {
    const double3 d = vector_at(direction, at + k);
    const double3 q = vector_at(multiplied, at + k);
    const double3 impulse =
        k == 0 ? body.mass * d : times_in_body(body.inertia, orientation_of(&pose), d);
    w[k] = vector_at(change, at + k) + length * d;
    r[k] = vector_at(residual, at + k) - length * (impulse - damping.dt * q);
    store_vector(w[k], change, at + k);
    store_vector(vector_at(change_of_force, at + k) + length * q, change_of_force, at + k);
    store_vector(r[k], residual, at + k);
  }
  const double error =
      product(r[0], by_mass(&body, r[0])) + product(r[1], by_inertia(&body, &pose, r[1]));
  const double size = body.mass * product(w[0], w[0]) +
                      product(w[1], times_in_body(body.inertia, orientation_of(&pose), w[1]));
  partial[groups + b] = (double4)(error, size, 0, 0);
}

kernel void end_damping_of_bodies(const int count, const int first, global const Rigid* rigid,
                                  global const double* change_of_force,
                                  global double* rigid_force) {
  const int b = get_global_id(0);
  if (b >= count || rigid[b].is_held) return;
  const Rigid body = rigid[b];
  const int of_force = 2 * b;
  const int of_torque = 2 * b + 1;
  const double3 force = felt_force(&body, vector_at(change_of_force, first + of_force));
  const double3 torque = felt_torque(&body, vector_at(change_of_force, first + of_torque));
  store_vector(vector_at(rigid_force, of_force) + force, rigid_force, of_force);
  store_vector(vector_at(rigid_force, of_torque) + torque, rigid_force, of_torque);
}
