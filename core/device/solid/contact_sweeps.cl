// Sweeps over contacts by projection, see ContactSolve::sweep(). A work-item relaxes the contacts of an
// island one after another.

int root_of(global int* parents, int end) {
  while (parents[end] != end) {
    parents[end] = parents[parents[end]];
    end = parents[end];
  }
  return end;
}

kernel void reset_islands(const int count, global int* parents, global int* island_of) {
  const int e = get_global_id(0);
  if (e >= count) return;
  parents[e] = e;
  island_of[e] = -1;
}

// The end by which a contact belongs to an island.
int moving_end(int free, global const Constraint* c) {
  return number_of_end(free, c->ends[0].inverse_mass > 0 ? &c->ends[0] : &c->ends[1]);
}

// Finds the islands, see ContactIslands: the contacts in `members`, from `begins` on. One work-item.
kernel void find_islands(const int free, global Projection* state,
                         global const Constraint* contacts, global int* parents,
                         global int* island_of, global int* begins, global int* members) {
  if (get_global_id(0) != 0) return;
  const int count = state->count;
  int present = 0;
  for (int n = 0; n < count; ++n) {
    global const Constraint* c = contacts + n;
    if (!c->is_present) continue;
    ++present;
    if (!(c->ends[0].inverse_mass > 0 && c->ends[1].inverse_mass > 0)) continue;
    const int a = root_of(parents, number_of_end(free, &c->ends[0]));
    const int b = root_of(parents, number_of_end(free, &c->ends[1]));
    parents[max(a, b)] = min(a, b);
  }
  int islands = 0;
  begins[0] = 0;
  for (int n = 0; n < count; ++n) {
    if (!contacts[n].is_present) continue;
    const int root = root_of(parents, moving_end(free, contacts + n));
    if (island_of[root] < 0) {
      island_of[root] = islands;
      ++islands;
      begins[islands] = 0;
    }
    ++begins[island_of[root] + 1];
  }
  for (int island = 1; island <= islands; ++island) begins[island] += begins[island - 1];
  for (int n = 0; n < count; ++n) {
    if (!contacts[n].is_present) continue;
    const int island = island_of[root_of(parents, moving_end(free, contacts + n))];
    members[begins[island]++] = n;
  }
  for (int island = islands; island > 0; --island) begins[island] = begins[island - 1];
  begins[0] = 0;
  state->islands = islands;
  state->unsolved = 0;
  state->unmet = 0;
  state->present = present;
}

void apply_to_end(global const ConstraintEnd* end, double3 impulse, global double* velocity,
                  global RigidMotion* motions) {
  if (end->inverse_mass == 0) return;
  if (end->rigid < 0) {
    const int i = end->particle;
    store_vector(vector_at(velocity, i) + end->inverse_mass * impulse, velocity, i);
    return;
  }
  global RigidMotion* motion = motions + end->rigid;
  const double3 turn =
      times_of(motion->inverse_inertia, cross_product(vector_at(end->arm, 0), impulse));
  store_vector(vector_at(motion->velocity, 0) + end->inverse_mass * impulse, motion->velocity, 0);
  store_vector(vector_at(motion->spin, 0) + turn, motion->spin, 0);
}

void apply_impulse(global const Constraint* c, double3 impulse, global double* velocity,
                   global RigidMotion* motions) {
  apply_to_end(&c->ends[0], impulse, velocity, motions);
  apply_to_end(&c->ends[1], -impulse, velocity, motions);
}

// The excess of a contact as a speed, see SweepRow::excess().
double excess_of(const ProjectionStep* step, global const Constraint* c, double3 slip,
                 global const double* velocity, global const RigidMotion* motions) {
  const double3 normal = vector_at(c->normal, 0);
  if (step->is_finish) return product(slip, normal) - c->parting;
  double3 late =
      velocity_of_end(&c->ends[0], vector_at(c->ends[0].late_arm, 0), velocity, motions);
  const double3 start = vector_at(c->start, 0);
  if (c->wall >= 0) {
    return product(late, normal) + (product(start, normal) - c->required) / step->dt;
  }
  late -= velocity_of_end(&c->ends[1], vector_at(c->ends[1].late_arm, 0), velocity, motions);
  return (size_of(start + step->dt * late) - c->required) / step->dt;
}

// Relaxes a contact, see SweepRow::relax().
double relax_contact(const ProjectionStep* step, global Constraint* c, global double* velocity,
                     global RigidMotion* motions) {
  const double3 normal = vector_at(c->normal, 0);
  double3 slip = slip_of(c, velocity, motions);
  const double excess = excess_of(step, c, slip, velocity, motions);
  const double change = fmax(0.0, c->push - excess * (1 / c->mobility)) - c->push;
  c->push += change;
  slip += change * times_of(c->matrix, normal);
  double3 whole = change * normal;
  double greatest = fabs(change);
  const double limit = c->friction * c->push;
  const double3 friction = vector_at(c->friction_impulse, 0);
  if (limit != 0 || friction.x != 0 || friction.y != 0 || friction.z != 0) {
    const double3 sideways = slip - product(slip, normal) * normal;
    const double resistance = product(sideways, times_of(c->matrix, sideways));
    double3 wanted = friction;
    if (resistance > 0) wanted -= product(sideways, sideways) / resistance * sideways;
    const double size = size_of(wanted);
    if (size > limit) wanted *= limit / size;
    const double3 rubbing = wanted - friction;
    store_vector(wanted, c->friction_impulse, 0);
    whole += rubbing;
    greatest = fmax(greatest, size_of(rubbing));
  }
  if (greatest > 0) apply_impulse(c, whole, velocity, motions);
  return step->dt * c->mobility / c->threshold * greatest;
}

// Extrapolates the impulses of an island. Returns the square of the gradients.
double extrapolate_island(global Constraint* contacts, global const int* members, int begin,
                          int end, double last, global double* velocity,
                          global RigidMotion* motions) {
  double size = 0;
  for (int n = begin; n < end; ++n) {
    global Constraint* c = contacts + members[n];
    const double3 gradient = vector_at(c->gradient, 0) + impulse_of(c);
    store_vector(gradient, c->gradient, 0);
    size += product(gradient, gradient);
  }
  const double share = size < last ? size / last : 0;
  for (int n = begin; n < end; ++n) {
    global Constraint* c = contacts + members[n];
    const double3 impulse = share * vector_at(c->direction, 0);
    store_vector(impulse + vector_at(c->gradient, 0), c->direction, 0);
    if (share == 0) continue;
    const double3 normal = vector_at(c->normal, 0);
    const double along = product(impulse, normal);
    c->push += along;
    store_vector(vector_at(c->friction_impulse, 0) + impulse - along * normal,
                 c->friction_impulse, 0);
    apply_impulse(c, impulse, velocity, motions);
  }
  return size;
}

// Adds the changes of the impulses to the momenta of rigid bodies.
void add_momenta(global Constraint* c, global Pose* poses) {
  const double3 change = impulse_of(c) - vector_at(c->earlier, 0);
  store_vector(impulse_of(c), c->earlier, 0);
  for (int k = 0; k < 2; ++k) {
    global const ConstraintEnd* end = &c->ends[k];
    if (end->inverse_mass == 0 || end->rigid < 0) continue;
    const double3 impulse = k == 0 ? change : -change;
    global Pose* pose = poses + end->rigid;
    const double3 turn = cross_product(vector_at(end->arm, 0), impulse);
    store_vector(vector_at(pose->momentum, 0) + impulse, pose->momentum, 0);
    store_vector(vector_at(pose->angular_momentum, 0) + turn, pose->angular_momentum, 0);
  }
}

// Relaxes the contacts of each island in order and in reverse order, until none changes. With
// `is_first`, first applies the impulses with which the solve starts.
kernel void sweep_islands(const ProjectionStep step, const int is_first, global Projection* state,
                          global const int* begins, global const int* members,
                          global Constraint* contacts, global double* velocity,
                          global RigidMotion* motions, global Pose* poses) {
  const int most = clamp(10000 / max(state->present, 1), 50, 1000);
  for (int island = get_global_id(0); island < state->islands; island += get_global_size(0)) {
    const int begin = begins[island];
    const int end = begins[island + 1];
    for (int n = begin; n < end; ++n) {
      global Constraint* c = contacts + members[n];
      store_vector((double3)(0), c->direction, 0);
      if (is_first) {
        apply_impulse(c, impulse_of(c) - vector_at(c->earlier, 0), velocity, motions);
      }
    }
    double last = 0;
    bool is_solved = false;
    int round = 0;
    while (round < most && !is_solved) {
      ++round;
      for (int n = begin; n < end; ++n) {
        global Constraint* c = contacts + members[n];
        store_vector(-impulse_of(c), c->gradient, 0);
      }
      double greatest = 0;
      for (int n = begin; n < end; ++n) {
        greatest =
            fmax(greatest, relax_contact(&step, contacts + members[n], velocity, motions));
      }
      for (int n = end - 1; n >= begin; --n) {
        greatest =
            fmax(greatest, relax_contact(&step, contacts + members[n], velocity, motions));
      }
      is_solved = greatest <= 1e-8;
      if (!is_solved) {
        last = extrapolate_island(contacts, members, begin, end, last, velocity, motions);
      }
    }
    for (int n = begin; n < end; ++n) add_momenta(contacts + members[n], poses);
    atomic_max(&state->iterations, 2 * round);
    if (!is_solved) atomic_or(&state->unsolved, 1);
  }
}
