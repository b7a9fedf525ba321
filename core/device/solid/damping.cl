// The solve for velocity-dependent forces, see solve_damping(): conjugate gradients for
// (M - dt D) w = dt f. The vectors are in the order of particles.

typedef struct {
  double error;
  double size;
  double permitted;
  double length;
  double share;
  int iterations;
  int is_open;
} DampingProgress;

typedef struct {
  double dt;
  double total_mass;
  double tolerance2;
  double velocity_tolerance2;
  int count;
  int most_iterations;
} Damping;

bool needs_iteration(const Damping* damping, global const DampingProgress* progress) {
  const double permitted = fmax(damping->tolerance2 * progress->size, progress->permitted);
  return progress->error > permitted && progress->iterations < damping->most_iterations;
}

// Begins a solve. Forces depend on the velocities `predicted`, and `velocity` are those before the
// forces act. `partial` receives <r, M^-1 r>, the sum of m v^2 and that of m (velocity - v)^2, and
// `momenta` that of m v, with v = predicted.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void begin_damping(
    const Damping damping, global const double* mass, global const double* mobility,
    global const double* velocity, global const double* predicted, global const double* force,
    global double* change, global double* change_of_force, global double* residual, global double* direction,
    global double4* partial, global double4* momenta) {
  local double4 sums[GROUP];
  const int i = get_global_id(0);
  double4 own = 0;
  double4 momentum = 0;
  if (i < damping.count) {
    const double3 v = vector_at(predicted, i);
    const double3 past = vector_at(velocity, i) - v;
    const double3 r = damping.dt * vector_at(force, i) + mass[i] * past;
    const double3 d = mobility[i] * r;
    store_vector((double3)(0), change, i);
    store_vector((double3)(0), change_of_force, i);
    store_vector(r, residual, i);
    store_vector(d, direction, i);
    own.x = product(r, d);
    if (mobility[i] > 0) {
      momentum.xyz = mass[i] * v;
      own.y = mass[i] * product(v, v);
    }
    own.z = mass[i] * product(past, past);
  }
  write_partial(sums, own, partial);
  barrier(CLK_LOCAL_MEM_FENCE);
  write_partial(sums, momentum, momenta);
}

// Computes the error that the velocities relative to their mean permit.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void open_damping(
    const Damping damping, const int groups, global const double4* partial,
    global const double4* momenta, global DampingProgress* progress) {
  local double4 sums[GROUP];
  const double4 total = sum_partial(sums, groups, partial);
  barrier(CLK_LOCAL_MEM_FENCE);
  const double3 momentum = sum_partial(sums, groups, momenta).xyz;
  if (get_local_id(0) != 0) return;
  const double of_mean =
      damping.total_mass > 0 ? product(momentum, momentum) / damping.total_mass : 0;
  progress->error = total.x;
  progress->size = total.z;
  progress->permitted = damping.velocity_tolerance2 * (total.y - of_mean);
  progress->share = 0;
  progress->iterations = 0;
  progress->is_open = needs_iteration(&damping, progress);
}

// Adds the dampers of the target's springs, whose directions are `ways`. `change` is the change of the
// velocities.
INLINE void add_dampers(global const uint* begins, global const SpringEnd* ends,
                        global const double* ways, global const double* change, Target* t) {
  const uint end = begins[t->index + 1];
  for (uint s = begins[t->index]; s < end; ++s) {
    const double3 n = vector_at(ways, s);
    const double speed = product(t->w - vector_at(change, ends[s].other), n);
    t->force -= (ends[s].damping * speed) * n;
  }
}

// Computes D times the direction, and <d, (M - dt D) d> of free particles. Uses the contacts and the
// directions of springs of find_solid_forces(). A particle of a rigid body without acting contacts has
// no product.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void multiply_damping(
    const Solids p, const Damping damping, global const DampingProgress* progress,
    global const int* begins, global const int* order, global const double* sorted,
    global const double* position, global const double* predicted, global const double* direction,
    global const double* spins, global const double* spin_changes, global const double* mass,
    global const double* radius, global const int* body_of, global const Body* bodies,
    global const ContactLaw* laws, global const uint* exclusion_begin,
    global const uint* exclusions, global const uint* spring_begin,
    global const SpringEnd* springs, global int* contact_counts, global uint* contacts,
    global const Mobility* mobilities, global const double* ways, global double* multiplied,
    global double* torque,
    global double4* partial) {
  local double4 sums[GROUP];
  if (!progress->is_open) return;
  const int i = get_global_id(0);
  const int acting = i < p.count ? contact_counts[i] : 0;
  double4 own = 0;
  if (acting != 0 || i < p.free) {
    Target t = target_at(&p, i, place_of_solid(&p, position, i), predicted, spins, mass, radius,
                         body_of, mobilities);
    t.is_change = 1;
    t.w = vector_at(direction, i);
    t.spin_change = vector_at(spin_changes, t.body);
    const ContactColumns columns = {begins, order, sorted, predicted, direction, spins,
                                    spin_changes, mass, radius, body_of, bodies, laws,
                                    exclusion_begin, exclusions};
    const int count = acting & (WALLS_ACT - 1);
    if (count > MOST_CONTACTS) {
      const ContactLists none = {0, contacts};
      add_contacts(&p, &columns, &none, &t);
    } else {
      for (int k = 0; k < count; ++k) {
        const uint near = contacts[k * p.count + i];
        add_contact_at(&p, &columns, near & ((1u << IMAGE_BIT) - 1),
                       shift_to(&p, near >> IMAGE_BIT), &t);
      }
    }
    if (i < p.implicit) add_dampers(spring_begin, springs, ways, direction, &t);
    if (acting & WALLS_ACT) {
      const int of_wall = p.materials * p.materials + p.materials + bodies[t.body].material;
      add_walls(&p, laws[of_wall], &t);
    }
    store_vector(t.force, multiplied, i);
    store_vector(t.torque, torque, i);
    if (i < p.free) own.x = product(t.w, t.mass * t.w - damping.dt * t.force);
  }
  write_partial(sums, own, partial);
}

// In the following kernels of one group, all work-items sum even if the solve is closed: PoCL 3.1
// does not end a kernel that returns before a barrier by a value that it changes after the barrier.

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_damping_length(
    const int groups, global const double4* partial, global DampingProgress* progress) {
  local double4 sums[GROUP];
  const double curvature = sum_partial(sums, groups, partial).x;
  if (get_local_id(0) != 0 || !progress->is_open) return;
  ++progress->iterations;
  if (curvature > 0) {
    progress->length = progress->error / curvature;
  } else {
    progress->is_open = 0;  // too small for the precision of numbers
  }
}

// Advances along the direction. `partial` receives the new error and size.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void advance_damping(
    const Damping damping, global const DampingProgress* progress, global const double* mass,
    global const double* mobility, global const double* velocity, global const double* predicted,
    global const double* direction, global const double* multiplied, global double* change, global double* change_of_force,
    global double* residual, global double4* partial) {
  local double4 sums[GROUP];
  if (!progress->is_open) return;
  const int i = get_global_id(0);
  double4 own = 0;
  if (i < damping.count) {
    const double length = progress->length;
    const double3 d = vector_at(direction, i);
    const double3 q = vector_at(multiplied, i);
    const double3 w = vector_at(change, i) + length * d;
    const double3 r = vector_at(residual, i) - length * (mass[i] * d - damping.dt * q);
    store_vector(w, change, i);
    store_vector(vector_at(change_of_force, i) + length * q, change_of_force, i);
    store_vector(r, residual, i);
    own.x = mobility[i] * product(r, r);
    const double3 gained = w - (vector_at(velocity, i) - vector_at(predicted, i));
    own.y = mass[i] * product(gained, gained);
  }
  write_partial(sums, own, partial);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void end_damping_iteration(
    const Damping damping, const int groups, global const double4* partial,
    global DampingProgress* progress) {
  local double4 sums[GROUP];
  const double4 total = sum_partial(sums, groups, partial);
  if (get_local_id(0) != 0 || !progress->is_open) return;
  progress->share = total.x / progress->error;
  progress->error = total.x;
  progress->size = total.y;
  progress->is_open = needs_iteration(&damping, progress);
}

kernel void turn_damping(const Damping damping, global const DampingProgress* progress,
                         global const double* mobility, global const double* residual,
                         global double* direction) {
  const int i = get_global_id(0);
  if (i >= damping.count || !progress->is_open) return;
  const double3 d = mobility[i] * vector_at(residual, i) + progress->share * vector_at(direction, i);
  store_vector(d, direction, i);
}

// Adds the changes of the forces to the forces.
kernel void end_damping(const Damping damping, global const double* change_of_force,
                        global double* force) {
  const int i = get_global_id(0);
  if (i >= damping.count) return;
  store_vector(vector_at(force, i) + vector_at(change_of_force, i), force, i);
}
