// Rigid bodies: poses, their particles, and resultants of forces. Quaternions have the order x, y, z,
// w. Bodies that are held do not feel forces, but move with constant momentum. `spins` and `speeds` are indexed by all bodies of the
// scene, and 0 for others.

typedef struct {
  double mass;
  double inverse_mass;
  double extent;
  double travel;
  double greatest_inverse_moment;
  double inertia[9];
  double inverse_inertia[9];
  double principal_axes[4];
  double inverse_moments[3];
  double axle[3];
  double brake;
  int splitting[3];
  int begin;
  int end;
  int body;
  int is_held;
  int has_axle;
  int is_driven;
  int padding;
} Rigid;

typedef struct {
  double center[3];
  double orientation[4];
  double momentum[3];
  double angular_momentum[3];
} Pose;

double3 three(const double* v) {
  return (double3)(v[0], v[1], v[2]);
}

double4 quaternion_product(double4 a, double4 b) {
  const double3 v = a.w * b.xyz + b.w * a.xyz + cross_product(a.xyz, b.xyz);
  return (double4)(v, a.w * b.w - product(a.xyz, b.xyz));
}

double4 conjugate(double4 q) {
  return (double4)(-q.xyz, q.w);
}

double4 normalized(double4 q) {
  return q / sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
}

double3 turn_by(double4 q, double3 v) {
  const double3 t = 2 * cross_product(q.xyz, v);
  return v + q.w * t + cross_product(q.xyz, t);
}

double3 times(const double* matrix, double3 v) {
  return (double3)(product(three(matrix), v), product(three(matrix + 3), v),
                   product(three(matrix + 6), v));
}

// The product of a matrix in body axes and a vector in world axes.
double3 times_in_body(const double* matrix, double4 q, double3 v) {
  return turn_by(q, times(matrix, turn_by(conjugate(q), v)));
}

double4 orientation_of(const Pose* pose) {
  const double* q = pose->orientation;
  return normalized((double4)(q[0], q[1], q[2], q[3]));
}

// 1 / (n (n + 1)) and 1 / (n (n - 1)) for n = 2, 4 ... 28.
constant double kOfSine[] = {
    1.0 / 6,   1.0 / 20,  1.0 / 42,  1.0 / 72,  1.0 / 110, 1.0 / 156, 1.0 / 210,
    1.0 / 272, 1.0 / 342, 1.0 / 420, 1.0 / 506, 1.0 / 600, 1.0 / 702, 1.0 / 812};
constant double kOfCosine[] = {
    1.0 / 2,   1.0 / 12,  1.0 / 30,  1.0 / 56,  1.0 / 90,  1.0 / 132, 1.0 / 182,
    1.0 / 240, 1.0 / 306, 1.0 / 380, 1.0 / 462, 1.0 / 552, 1.0 / 650, 1.0 / 756};

// The sine and cosine for |x| <= 3, by their series. Built-in functions of devices differ. The terms
// that small arguments do not need are below 10^-18.
double2 sine_and_cosine(double x) {
  const double square = x * x;
  double sine = 1;
  double cosine = 1;
  for (int n = square < 4e-4 ? 2 : square < 0.25 ? 7 : 13; n >= 0; --n) {
    sine = 1 - square * kOfSine[n] * sine;
    cosine = 1 - square * kOfCosine[n] * cosine;
  }
  return (double2)(x * sine, cosine);
}

// See turn_about() of core/state/rigid_motion.cpp.
void turn_about(int axis, double rate_excess, double dt, double4* orientation, double* m) {
  const double2 of_half = sine_and_cosine(0.5 * dt * rate_excess * m[axis]);
  const double s = of_half.x;
  const double c = of_half.y;
  const double4 turn = (double4)(axis == 0 ? s : 0, axis == 1 ? s : 0, axis == 2 ? s : 0, c);
  *orientation = quaternion_product(*orientation, turn);
  const int first = (axis + 1) % 3;
  const int second = (axis + 2) % 3;
  const double cosine = c * c - s * s;
  const double sine = 2 * s * c;
  const double kept = m[first];
  m[first] = cosine * kept + sine * m[second];
  m[second] = cosine * m[second] - sine * kept;
}

// The orientation after a motion without torque, see rotate_freely().
double4 rotate_freely(const Rigid* body, double4 orientation, double3 angular_momentum, double dt) {
  const double outer = 0.41449077179437573714;  // 1 / (4 - cbrt(4))
  const double* axes = body->principal_axes;
  const double4 principal = (double4)(axes[0], axes[1], axes[2], axes[3]);
  double4 q = quaternion_product(orientation, principal);
  const double3 own = turn_by(conjugate(q), angular_momentum);
  double m[3] = {own.x, own.y, own.z};
  const double common = body->inverse_moments[body->splitting[0]];
  const int near = body->splitting[1];
  const int far = body->splitting[2];
  const double near_excess = body->inverse_moments[near] - common;
  const double far_excess = body->inverse_moments[far] - common;
  for (int part = 0; part < 5; ++part) {
    const double share = part == 2 ? 1 - 4 * outer : outer;
    turn_about(near, near_excess, share * dt / 2, &q, m);
    turn_about(far, far_excess, share * dt, &q, m);
    turn_about(near, near_excess, share * dt / 2, &q, m);
  }
  const double size = sqrt(product(angular_momentum, angular_momentum));
  const double2 of_half = sine_and_cosine(0.5 * (common * size * dt));
  const double3 axis = size > 0 ? angular_momentum / size : (double3)(1, 0, 0);
  const double4 about_momentum = (double4)(of_half.x * axis, of_half.y);
  return normalized(quaternion_product(quaternion_product(about_momentum, q), conjugate(principal)));
}

double3 spin_of(const Rigid* body, double4 orientation, double3 angular_momentum) {
  return times_in_body(body->inverse_inertia, orientation, angular_momentum);
}

void kick_rigid(Pose* pose, global const double* force, int b, double dt) {
  for (int k = 0; k < 3; ++k) {
    pose->momentum[k] += dt * force[6 * b + k];
    pose->angular_momentum[k] += dt * force[6 * b + 3 + k];
  }
}

// Checks the state of a body at the end of a step of `dt`, see find_rigid_fault().
void check_rigid(const Solids* p, const Rigid* body, double dt, const Pose* pose,
                 global int* status) {
  const double3 velocity = body->inverse_mass * three(pose->momentum);
  const double3 omega =
      spin_of(body, orientation_of(pose), three(pose->angular_momentum));
  const double spin = sqrt(product(omega, omega));
  const double speed = sqrt(product(velocity, velocity)) + body->extent * spin;
  const double at_rest[3] = {0, 0, 0};
  // In this form, a NaN fails.
  const bool is_slow = speed <= fmin(p->max_speed, body->travel / dt) && spin * dt <= 1;
  if (!is_slow || !is_within(p->domain_low, p->domain_high, 0, pose->center, at_rest)) {
    atomic_or(status + kFault, 1);
  }
}

// Ends a step of `dt`: kicks the body and checks its state.
void end_rigid_step(const Solids* p, const Rigid* body, global const double* force, int b,
                    double dt, Pose* pose, global int* status) {
  if (!(p->closing > 0)) return;
  kick_rigid(pose, force, b, p->closing);
  for (int k = 0; k < 3 && body->has_axle; ++k) pose->angular_momentum[k] *= body->brake;
  check_rigid(p, body, dt, pose, status);
}

bool is_zero(const double* v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

// Whether a body does not rotate before its release. Its orientation remains bitwise equal.
bool keeps_orientation(const Rigid* body, const Pose* pose) {
  return body->is_held && is_zero(pose->angular_momentum);
}

// Moves a body by its velocity and its free rotation. The kernel drive_rigid_body moves the centre of
// a driven body.
void drift_rigid(const Rigid* body, double dt, Pose* pose) {
  for (int k = 0; k < 3 && !body->is_driven; ++k) {
    pose->center[k] += (dt * body->inverse_mass) * pose->momentum[k];
  }
  if (keeps_orientation(body, pose)) return;
  const double4 q =
      rotate_freely(body, orientation_of(pose), three(pose->angular_momentum), dt);
  pose->orientation[0] = q.x;
  pose->orientation[1] = q.y;
  pose->orientation[2] = q.z;
  pose->orientation[3] = q.w;
}

// Ends a step, and begins the next one with a kick and a drift. The velocities that forces depend on
// are kicked by p.prediction.
kernel void move_rigid_bodies(const Solids p, const int count, const double dt,
                              global const Rigid* rigid, global const double* force,
                              global Pose* poses, global double* speeds, global double* spins,
                              global int* status) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  Pose pose = poses[b];
  end_rigid_step(&p, &body, force, b, dt, &pose, status);
  kick_rigid(&pose, force, b, p.opening);
  if (p.drift > 0) drift_rigid(&body, p.drift, &pose);
  poses[b] = pose;
  kick_rigid(&pose, force, b, p.prediction);
  store_vector(body.inverse_mass * three(pose.momentum), speeds, body.body);
  store_vector(spin_of(&body, orientation_of(&pose), three(pose.angular_momentum)), spins,
               body.body);
}

typedef struct {
  double way[3];
  double velocity[3];
} Drive;

// Moves the centre of the driven body b, and gives it a velocity. Runs with one work-item of index 0.
kernel void drive_rigid_body(const int b, const Drive drive, global const Rigid* rigid,
                             global Pose* poses, global double* speeds) {
  if (get_global_id(0) != 0) return;
  for (int k = 0; k < 3; ++k) {
    poses[b].center[k] += drive.way[k];
    poses[b].momentum[k] = rigid[b].mass * drive.velocity[k];
  }
  store_vector(three(drive.velocity), speeds, rigid[b].body);
}

// Ends the last step of a call.
kernel void finish_rigid_bodies(const Solids p, const int count, const double dt,
                                global const Rigid* rigid, global const double* force,
                                global Pose* poses, global int* status) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  Pose pose = poses[b];
  end_rigid_step(&p, &body, force, b, dt, &pose, status);
  poses[b] = pose;
}

// Sets the positions and velocities of the particles of rigid bodies. `p` are the parameters at the
// time of the positions. A particle beyond a wall is a fault, because only the CPU moves bodies back.
kernel void pose_rigid_particles(const Solids p, global const Rigid* rigid,
                                 global const int* rigid_of, global const double* local_position,
                                 global const Pose* poses, global const double* speeds,
                                 global const double* spins, global double* position,
                                 global double* predicted, global int* status) {
  const int e = get_global_id(0);
  if (p.free + e >= p.count) return;
  const int b = rigid_of[e];
  const Pose pose = poses[b];
  const int body = rigid[b].body;
  const double3 arm = turn_by(orientation_of(&pose), vector_at(local_position, e));
  const double3 at = three(pose.center) + arm;
  store_vector(at, position, p.free + e);
  store_vector(vector_at(speeds, body) + cross_product(vector_at(spins, body), arm), predicted,
               p.free + e);
  const double x[3] = {at.x, at.y, at.z};
  for (int wall = 0; wall < 6; ++wall) {
    const bool is_beyond =
        ((p.walls >> wall) & 1) && distance_from_wall(&p, wall, x[wall / 2]) < 0;
    if (is_beyond && !rigid[b].is_held && !rigid[b].has_axle) atomic_or(status + kFault, 1);
  }
}

// The sums of forces and of torques on a body, for one group.
typedef struct {
  double3 force;
  double3 torque;
} Resultant;

// `torque` has additional torques on the particles, or is null. If `acting` is not null, particles
// for which it is 0 have no force.
Resultant resultant_of(local double4* forces, local double4* torques, const Rigid* body,
                       double3 center, global const double* position, global const double* force,
                       global const double* torque, global const int* acting) {
  const int count = body->end - body->begin;
  const int first = LANES * get_local_id(0);
  const int end = min(first + LANES, leaves_of_tree(count));
  for (int t = first; t < end; ++t) {
    double3 own_force = 0;
    double3 own_torque = 0;
    for (int e = body->begin + t; e < body->end; e += GROUP) {
      if (acting != 0 && acting[e] == 0) continue;
      const double3 f = vector_at(force, e);
      own_force += f;
      double3 about = cross_product(vector_at(position, e) - center, f);
      if (torque != 0) about += vector_at(torque, e);
      own_torque += about;
    }
    forces[t] = (double4)(own_force, 0);
    torques[t] = (double4)(own_torque, 0);
  }
  COMBINE_SOME(forces, count, combined)
  COMBINE_SOME(torques, count, combined)
  const Resultant total = {forces[0].xyz, torques[0].xyz};
  barrier(CLK_LOCAL_MEM_FENCE);
  return total;
}

// The parts of a force and a torque that a body feels, see apply_axle().
double3 felt_force(const Rigid* body, double3 force) {
  return body->is_held || body->has_axle ? (double3)(0) : force;
}
double3 felt_torque(const Rigid* body, double3 torque) {
  if (body->is_held) return 0;
  const double3 axle = three(body->axle);
  return body->has_axle ? product(axle, torque) * axle : torque;
}

// Sums the forces on the particles of each body, see gather_rigid_forces(). `bounds` receives the
// bound of the oscillations of the body in its contacts, see find_bound(). One group for each body.
kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void gather_rigid_forces(
    const int has_friction, global const Rigid* rigid, global const Pose* poses,
    global const double* position, global const double* radius, global const double* force,
    global const double* torque, global const double2* loads, global double* rigid_force,
    global double2* bounds) {
  local double4 sums[GROUP];
  local double4 torques[GROUP];
  const int b = get_group_id(0);
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const double3 center = three(pose.center);
  const Resultant total = resultant_of(sums, torques, &body, center, position, force, torque, 0);
  const int first = LANES * get_local_id(0);
  const int end = min(first + LANES, leaves_of_tree(body.end - body.begin));
  for (int t = first; t < end; ++t) {
    double4 bound = 0;
    for (int e = body.begin + t; e < body.end; e += GROUP) {
      const double2 load = loads[e];
      const double3 arm = vector_at(position, e) - center;
      double arm2 = product(arm, arm);
      if (has_friction) {
        const double reach = sqrt(arm2) + radius[e];
        arm2 = reach * reach;
      }
      bound.xy += (body.inverse_mass + arm2 * body.greatest_inverse_moment) * load;
    }
    sums[t] = bound;
  }
  COMBINE_SOME(sums, body.end - body.begin, combined)
  if (get_local_id(0) != 0) return;
  store_vector(felt_force(&body, total.force), rigid_force, 2 * b);
  store_vector(felt_torque(&body, total.torque), rigid_force, 2 * b + 1);
  bounds[b] = sums[0].xy;
}
