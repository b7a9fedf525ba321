// The integrators without a closing kick: symplectic Euler, and explicit Runge-Kutta methods, see
// core/stepping/runge_kutta.h. `p` are the parameters at the end of a step of `dt`.

// Takes a step of symplectic Euler, with a kick by `by`.
kernel void take_euler_step(const Solids p, const double by, const double dt, global double* position,
                            global double* velocity, global const double* force,
                            global const double* mobility, global const int* body_of,
                            global const Body* bodies, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.free) return;
  double x[3];
  double v[3];
  for (int k = 0; k < 3; ++k) {
    v[k] = velocity[3 * i + k] + (by * mobility[i]) * force[3 * i + k];
    x[k] = position[3 * i + k] + dt * v[k];
  }
  check_solid(&p, mobility[i], greatest_speed2_of(&p, bodies + body_of[i]), x, v, status);
  for (int k = 0; k < 3; ++k) {
    position[3 * i + k] = x[k];
    velocity[3 * i + k] = v[k];
  }
}

kernel void take_euler_step_of_bodies(const Solids p, const int count, const double dt,
                                      global const Rigid* rigid, global const double* force,
                                      global Pose* poses, global int* status) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  Pose pose = poses[b];
  kick_rigid(&pose, force, b, dt);
  drift_rigid(&body, dt, &pose);
  check_rigid(&p, &body, dt, &pose, status);
  poses[b] = pose;
}

// Adds `weight` times the present rates to the sums, and moves to the next stage, `way` times the
// rates after the start of the step.
kernel void advance_stage(const int count, const double weight, const double way,
                          global double* position, global double* velocity,
                          global const double* start_position,
                          global const double* start_velocity, global double* sum_of_velocity,
                          global double* sum_of_acceleration, global const double* force,
                          global const double* mobility) {
  const int i = get_global_id(0);
  if (i >= count) return;
  for (int n = 3 * i; n < 3 * i + 3; ++n) {
    const double v = velocity[n];
    const double a = mobility[i] * force[n];
    sum_of_velocity[n] += weight * v;
    sum_of_acceleration[n] += weight * a;
    position[n] = start_position[n] + way * v;
    velocity[n] = start_velocity[n] + way * a;
  }
}

// Ends a step by the sums of its rates.
kernel void end_stages(const Solids p, const double dt, global double* position,
                       global double* velocity, global const double* start_position,
                       global const double* start_velocity,
                       global const double* sum_of_velocity,
                       global const double* sum_of_acceleration, global const double* mobility,
                       global const int* body_of, global const Body* bodies, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.free) return;
  double x[3];
  double v[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = start_position[3 * i + k] + dt * sum_of_velocity[3 * i + k];
    v[k] = start_velocity[3 * i + k] + dt * sum_of_acceleration[3 * i + k];
  }
  check_solid(&p, mobility[i], greatest_speed2_of(&p, bodies + body_of[i]), x, v, status);
  for (int k = 0; k < 3; ++k) {
    position[3 * i + k] = x[k];
    velocity[3 * i + k] = v[k];
  }
}

// The rate of change of a body, in the same members.
Pose rate_of_rigid(const Rigid* body, const Pose* pose, global const double* force, int b) {
  const double3 omega = spin_of(body, orientation_of(pose), three(pose->angular_momentum));
  const double* q = pose->orientation;
  const double4 turn =
      0.5 * quaternion_product((double4)(omega, 0), (double4)(q[0], q[1], q[2], q[3]));
  const double turns[4] = {turn.x, turn.y, turn.z, turn.w};
  Pose rate;
  for (int k = 0; k < 4; ++k) rate.orientation[k] = turns[k];
  for (int k = 0; k < 3; ++k) {
    rate.center[k] = body->inverse_mass * pose->momentum[k];
    rate.momentum[k] = force[6 * b + k];
    rate.angular_momentum[k] = force[6 * b + 3 + k];
  }
  return rate;
}

void add_scaled_rate(Pose* sum, double scale, const Pose* rate) {
  for (int k = 0; k < 4; ++k) sum->orientation[k] += scale * rate->orientation[k];
  for (int k = 0; k < 3; ++k) {
    sum->center[k] += scale * rate->center[k];
    sum->momentum[k] += scale * rate->momentum[k];
    sum->angular_momentum[k] += scale * rate->angular_momentum[k];
  }
}

kernel void advance_stage_of_bodies(const int count, const double weight, const double way,
                                    global const Rigid* rigid, global const double* force,
                                    global const Pose* start, global Pose* sums,
                                    global Pose* poses) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  const Pose now = poses[b];
  const Pose rate = rate_of_rigid(&body, &now, force, b);
  Pose sum = sums[b];
  add_scaled_rate(&sum, weight, &rate);
  sums[b] = sum;
  Pose next = start[b];
  add_scaled_rate(&next, way, &rate);
  poses[b] = next;
}

kernel void end_stages_of_bodies(const Solids p, const int count, const double dt,
                                 global const Rigid* rigid, global const Pose* start,
                                 global const Pose* sums, global Pose* poses,
                                 global int* status) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  const Pose sum = sums[b];
  Pose pose = start[b];
  const bool is_kept = keeps_orientation(&body, &pose);
  add_scaled_rate(&pose, dt, &sum);
  const double4 q = orientation_of(&pose);
  const double turned[4] = {q.x, q.y, q.z, q.w};
  for (int k = 0; k < 4 && !is_kept; ++k) pose.orientation[k] = turned[k];
  check_rigid(&p, &body, dt, &pose, status);
  poses[b] = pose;
}
