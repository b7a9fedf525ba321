// Contacts by projection, see core/contact/projection/projection.h: their search, geometry and records.
// The contacts are in the order of their first particles, and then of walls and second particles.
// Particles are counted from the first solid particle.

// The law of contacts, in the order of the table of ContactLaw.
typedef struct {
  double threshold;
  double friction;
  double restitution;
  int is_projected;
  int padding;
} ProjectedLaw;

// The forces of a contact in the last step, see ContactImpulse.
typedef struct {
  double drift[3];
  double finish[3];
  int particle;
  int other;  // a wall, or WALLS + index of the other particle
  int is_steady;
  int is_present;
} ContactRecord;

#define WALLS 6

typedef struct {
  double inverse_mass;
  double arm[3];
  double late_arm[3];
  int particle;  // -1: a wall
  int rigid;     // -1: not of a rigid body
} ConstraintEnd;

// See ContactConstraint and SweepRow.
typedef struct {
  ConstraintEnd ends[2];
  double threshold;
  double friction;
  double restitution;
  double normal[3];
  double wall_velocity[3];
  double mobility;
  double approach;
  double parting;
  double required;  // distance at the end of the step
  double push;
  double friction_impulse[3];
  double earlier[3];  // impulse at the start of a solve
  double last_drift[3];
  double last_finish[3];
  double drift[3];
  double start[3];  // relative position without velocities
  double matrix[9]; // change of slip per impulse
  double gradient[3];
  double direction[3];
  int wall;
  int is_steady;
  int is_present;
  int padding;
} Constraint;

// The motion of a rigid body, see RigidMotion.
typedef struct {
  double velocity[3];
  double spin[3];
  double inverse_inertia[9];
  double inverse_mass;
} RigidMotion;

typedef struct {
  int count;      // contacts of the present step
  int recorded;   // contacts of the last step
  int present;    // contacts of the present solve
  int unsolved;
  int unmet;
  int iterations; // of the slowest island of the present solve
  int islands;
  int padding;
  ulong all_iterations;
} Projection;

typedef struct {
  double dt;
  double margin;        // greatest gap of a contact, in thresholds
  double reach;         // greatest distance of two particles in contact [m]
  double slow;          // approach speed that counts as rest [m/s]
  double vat_offset[3]; // at the end of the step
  double wall_velocity[3];
  int capacity;
  int is_finish;
} ProjectionStep;

double3 local_vector(const double* v) {
  return (double3)(v[0], v[1], v[2]);
}

double3 times_of(global const double* matrix, double3 v) {
  return (double3)(product(vector_at(matrix, 0), v), product(vector_at(matrix, 1), v),
                   product(vector_at(matrix, 2), v));
}

// The vector between two particles; in a periodic world to the nearest image.
double3 nearest(const Solids* p, double3 x) {
  double way[3] = {x.x, x.y, x.z};
  for (int k = 0; k < 3; ++k) {
    if (p->period[k] > 0) way[k] -= p->period[k] * rint(way[k] / p->period[k]);
  }
  return (double3)(way[0], way[1], way[2]);
}

double3 normal_of_wall(int wall) {
  const double side = wall % 2 == 0 ? 1 : -1;
  const int axis = wall / 2;
  return (double3)(axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0);
}

double gap_of_wall(const Solids* p, const ProjectionStep* step, int wall, double3 at) {
  const int axis = wall / 2;
  const double x = (axis == 0 ? at.x : axis == 1 ? at.y : at.z) - step->vat_offset[axis];
  return wall % 2 == 0 ? x - p->wall_low[axis] : p->wall_high[axis] - x;
}

// Moves free particles from the start of the step with their present velocities.
kernel void predict_particles(const int count, const double dt, global const double* start, global const double* velocity,
                              global double* position) {
  const int i = get_global_id(0);
  if (i >= count) return;
  store_vector(vector_at(start, i) + dt * vector_at(velocity, i), position, i);
}

// Moves rigid bodies from the poses at the start of the step with their present momenta. `predicted`
// receives their present motion.
kernel void predict_bodies(const int count, const double dt, global const Rigid* rigid, global const Pose* start,
                           global Pose* poses, global const RigidMotion* motions,
                           global RigidMotion* predicted, global double* speeds,
                           global double* spins) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  Pose pose = poses[b];
  const Pose from = start[b];
  for (int k = 0; k < 3; ++k) pose.center[k] = from.center[k];
  for (int k = 0; k < 4; ++k) pose.orientation[k] = from.orientation[k];
  drift_rigid(&body, dt, &pose);
  poses[b] = pose;
  predicted[b] = motions[b];
  store_vector(body.inverse_mass * three(pose.momentum), speeds, body.body);
  store_vector(spin_of(&body, orientation_of(&pose), three(pose.angular_momentum)), spins,
               body.body);
}

// Kicks rigid bodies by the forces over `dt`.
kernel void kick_rigid_bodies(const int count, const double dt, global const double* force,
                              global Pose* poses) {
  const int b = get_global_id(0);
  if (b >= count) return;
  Pose pose = poses[b];
  kick_rigid(&pose, force, b, dt);
  poses[b] = pose;
}

// Checks the state of rigid bodies at the end of a step of `dt`.
kernel void check_rigid_bodies(const Solids p, const int count, const double dt,
                               global const Rigid* rigid, global const Pose* poses,
                               global int* status) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  check_rigid(&p, &body, dt, &pose, status);
}

// Adds the present particles to their cells.
kernel void enter_solid_cells(const Solids p, global const double* position,
                              global int* cell_of, global int* rank, global int* cell_counts) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  const double x[3] = {position[3 * i], position[3 * i + 1], position[3 * i + 2]};
  enter_solid(&p, i, x, cell_of, rank, cell_counts);
}

// The motions of rigid bodies, see rigid_motion().
kernel void find_motions(const int count, global const Rigid* rigid, global const Pose* poses,
                         global RigidMotion* motions, global RigidMotion* predicted) {
  const int b = get_global_id(0);
  if (b >= count) return;
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const double4 q = orientation_of(&pose);
  RigidMotion motion;
  const double3 velocity = body.inverse_mass * three(pose.momentum);
  const double3 spin = spin_of(&body, q, three(pose.angular_momentum));
  const double velocities[6] = {velocity.x, velocity.y, velocity.z, spin.x, spin.y, spin.z};
  for (int k = 0; k < 3; ++k) {
    motion.velocity[k] = velocities[k];
    motion.spin[k] = velocities[3 + k];
    const double3 unit = (double3)(k == 0, k == 1, k == 2);
    const double3 column =
        body.is_held ? (double3)(0) : times_in_body(body.inverse_inertia, q, unit);
    motion.inverse_inertia[k] = column.x;
    motion.inverse_inertia[3 + k] = column.y;
    motion.inverse_inertia[6 + k] = column.z;
  }
  motion.inverse_mass = body.is_held ? 0 : body.inverse_mass;
  motions[b] = motion;
  predicted[b] = motion;
}

double mobility_of_solid(const Solids* p, int i, global const double* mobility,
                         global const int* rigid_of, global const Rigid* rigid) {
  if (i < p->free) return mobility[i];
  const int b = rigid_of[i - p->free];
  return rigid[b].is_held ? 0 : rigid[b].inverse_mass;
}

// Adds a contact to the first `count` contacts of a particle, which are in the order of `other`.
void insert_contact(global Constraint* found, int count, int particle, int other,
                    const ProjectedLaw* law, double threshold) {
  int at = count;
  while (at > 0 && found[at - 1].padding > other) {
    found[at] = found[at - 1];
    --at;
  }
  global Constraint* c = found + at;
  c->padding = other;
  c->wall = other < WALLS ? other : -1;
  c->ends[0].particle = particle;
  c->ends[1].particle = other < WALLS ? -1 : other - WALLS;
  c->threshold = threshold;
  c->friction = law->friction;
  c->restitution = law->restitution;
}

// Counts the contacts of each particle with walls and later particles. With `is_writing`, writes them
// from `begins` on.
kernel void find_projections(const Solids p, const ProjectionStep step, const int is_writing,
                             global const int* cell_begins, global const int* order,
                             global const double* sorted, global const double* mobility,
                             global const double* radius, global const int* body_of,
                             global const Body* bodies, global const ProjectedLaw* laws,
                             global const int* rigid_of, global const Rigid* rigid,
                             global const int* begins, global int* counts,
                             global Constraint* contacts) {
  const int slot = get_global_id(0);
  if (slot >= p.count) return;
  const int i = order[slot];
  const double3 x = sorted_at(&p, sorted, slot);
  const int body = body_of[i];
  const int material = bodies[body].material;
  const bool moves = mobility_of_solid(&p, i, mobility, rigid_of, rigid) > 0;
  const bool fits = is_writing && begins[i + 1] <= step.capacity;
  global Constraint* own = contacts + (fits ? begins[i] : 0);
  int count = 0;
  const ProjectedLaw of_wall = laws[p.materials * p.materials + p.materials + material];
  if (of_wall.is_projected && moves) {
    const double threshold = of_wall.threshold > 0 ? of_wall.threshold : radius[i];
    for (int wall = 0; wall < WALLS; ++wall) {
      if (!((p.walls >> wall) & 1)) continue;
      if (gap_of_wall(&p, &step, wall, x) > (1 + step.margin) * threshold) continue;
      if (fits) insert_contact(own, count, i, wall, &of_wall, threshold);
      ++count;
    }
  }
  const double reach = (1 + step.margin) * step.reach;
  if (step.reach > 0) {
    FOR_EACH_ROW_OF_SOLIDS(&p, x, reach, cell_begins, {
      for (int s = begin; s < end; ++s) {
        const int j = order[s];
        if (j <= i || body_of[j] == body) continue;
        const int other = bodies[body_of[j]].material;
        if (i < p.liquids && j < p.liquids && material == other) continue;
        const ProjectedLaw law = laws[material * p.materials + other];
        if (!law.is_projected) continue;
        const double3 way = x - sorted_at(&p, sorted, s) + shift;
        const double threshold = law.threshold > 0 ? law.threshold : radius[i] + radius[j];
        if (sqrt(product(way, way)) > (1 + step.margin) * threshold) continue;
        if (!moves && !(mobility_of_solid(&p, j, mobility, rigid_of, rigid) > 0)) continue;
        if (fits) insert_contact(own, count, i, WALLS + j, &law, threshold);
        ++count;
      }
    })
  }
  if (!is_writing) counts[i] = count;
}

// Begins the solve at the start of a step. Too many contacts are a fault.
kernel void begin_projections(const int particles, const int capacity, global const int* begins,
                              global Projection* state, global int* status) {
  if (get_global_id(0) != 0) return;
  state->unsolved = 0;
  state->unmet = 0;
  state->iterations = 0;
  const int count = begins[particles];
  if (count > capacity) atomic_or(status + kFault, 1);
  state->count = count > capacity ? 0 : count;
  state->present = state->count;
}

double3 velocity_of_end(global const ConstraintEnd* end, double3 arm, global const double* velocity,
                        global const RigidMotion* motions) {
  if (end->rigid < 0) return vector_at(velocity, end->particle);
  global const RigidMotion* motion = motions + end->rigid;
  return vector_at(motion->velocity, 0) + cross_product(vector_at(motion->spin, 0), arm);
}

double3 slip_of(global const Constraint* c, global const double* velocity,
                global const RigidMotion* motions) {
  const double3 own = velocity_of_end(&c->ends[0], vector_at(c->ends[0].arm, 0), velocity, motions);
  if (c->wall >= 0) return own - vector_at(c->wall_velocity, 0);
  return own - velocity_of_end(&c->ends[1], vector_at(c->ends[1].arm, 0), velocity, motions);
}

double3 impulse_of(global const Constraint* c) {
  return c->push * vector_at(c->normal, 0) + vector_at(c->friction_impulse, 0);
}

// Adds the part of an end to the matrix of a contact.
void add_mobility(global const ConstraintEnd* end, global const RigidMotion* motions,
                  double* matrix) {
  for (int k = 0; k < 3; ++k) matrix[4 * k] += end->inverse_mass;
  if (end->rigid < 0) return;
  const double3 arm = vector_at(end->arm, 0);
  for (int k = 0; k < 3; ++k) {
    const double3 unit = (double3)(k == 0, k == 1, k == 2);
    const double3 turn =
        times_of(motions[end->rigid].inverse_inertia, cross_product(arm, unit));
    const double3 column = cross_product(turn, arm);
    matrix[k] += column.x;
    matrix[3 + k] += column.y;
    matrix[6 + k] += column.z;
  }
}

// Sets the direction of a contact, and the distance of its ends.
double set_normal(const Solids* p, const ProjectionStep* step, global Constraint* c,
                  global const double* position, global const double* later) {
  const int i = c->ends[0].particle;
  if (c->wall >= 0) {
    store_vector(normal_of_wall(c->wall), c->normal, 0);
    return gap_of_wall(p, step, c->wall, vector_at(position, i));
  }
  const int j = c->ends[1].particle;
  const double3 x = nearest(p, vector_at(position, i) - vector_at(position, j));
  const double3 y = nearest(p, vector_at(later, i) - vector_at(later, j));
  const double distance = sqrt(product(x, x));
  const double late = sqrt(product(y, y));
  const double3 normal =
      distance > 0 ? x / distance : direction_if_coincident(p->first + i, p->first + j, p->dimensions);
  const double3 late_normal =
      late > 0 ? y / late : direction_if_coincident(p->first + i, p->first + j, p->dimensions);
  // At larger angles the ends pass each other.
  store_vector(product(normal, late_normal) < 0.5 ? late_normal : normal, c->normal, 0);
  return distance;
}

void set_contact_arms(const Solids* p, global Constraint* c, double distance,
                      global const double* radius, global const double* position,
                      global const Pose* poses) {
  global ConstraintEnd* first = &c->ends[0];
  global ConstraintEnd* second = &c->ends[1];
  double share = 1;  // of the distance, from the first end
  if (first->rigid < 0) {
    share = 0;
  } else if (second->rigid >= 0) {
    share = radius[first->particle] / (radius[first->particle] + radius[second->particle]);
  }
  const double3 normal = vector_at(c->normal, 0);
  for (int k = 0; k < 2; ++k) {
    global ConstraintEnd* end = &c->ends[k];
    double3 arm = 0;
    if (end->rigid >= 0) {
      const Pose pose = poses[end->rigid];
      const double way = k == 0 ? -share : 1 - share;
      arm = vector_at(position, end->particle) - three(pose.center) + way * distance * normal;
    }
    store_vector(arm, end->arm, 0);
  }
}

// Finds the record of a contact in the last step; its index, or -1.
int find_record(global const ContactRecord* records, int count, int particle, int other) {
  int low = 0;
  int high = count;
  while (low < high) {
    const int middle = (low + high) / 2;
    const bool is_before = records[middle].particle < particle ||
                           (records[middle].particle == particle && records[middle].other < other);
    if (is_before) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  const bool is_found = low < count && records[low].particle == particle &&
                        records[low].other == other && records[low].is_present;
  return is_found ? low : -1;
}

// Changes the impulse of a contact by that of the last step, within its limits; see start_from(). The
// velocities change in the solve.
void start_contact(global Constraint* c, double3 impulse) {
  const double3 whole = impulse_of(c) + impulse;
  const double3 normal = vector_at(c->normal, 0);
  const double along = product(whole, normal);
  c->push = fmax(0.0, along);
  double3 across = whole - along * normal;
  const double limit = c->friction * c->push;
  const double size = sqrt(product(across, across));
  if (size > limit) across *= limit / size;
  store_vector(across, c->friction_impulse, 0);
}

// Sets the geometry of the contacts at the positions `position`, and the impulses with which a solve
// starts. `later` are the positions at the end of the step.
kernel void set_contact_geometry(const Solids p, const ProjectionStep step,
                                 global const Projection* state, global const double* position,
                                 global const double* later, global const double* velocity,
                                 global const double* mobility, global const double* radius,
                                 global const int* rigid_of, global const Rigid* rigid,
                                 global const Pose* poses, global const RigidMotion* motions,
                                 global const ContactRecord* records,
                                 global Constraint* contacts) {
  const int n = get_global_id(0);
  if (n >= state->count) return;
  global Constraint* c = contacts + n;
  if (step.is_finish) {
    // Contacts without an impulse and with a gap have ended.
    const double3 x = vector_at(position, c->ends[0].particle);
    double gap = 0;
    if (c->wall >= 0) {
      gap = gap_of_wall(&p, &step, c->wall, x);
    } else {
      const double3 way = nearest(&p, x - vector_at(position, c->ends[1].particle));
      gap = sqrt(product(way, way));
    }
    c->is_present = !(c->push == 0 && gap - c->threshold > 1e-3 * c->threshold);
  } else {
    for (int k = 0; k < 2; ++k) {
      global ConstraintEnd* end = &c->ends[k];
      const int i = end->particle;
      end->rigid = i >= p.free ? rigid_of[i - p.free] : -1;
      end->inverse_mass = i < 0 ? 0 : mobility_of_solid(&p, i, mobility, rigid_of, rigid);
    }
    c->push = 0;
    store_vector((double3)(0), c->friction_impulse, 0);
    c->is_present = 1;
  }
  const int wall = max(c->wall, 0);
  for (int k = 0; k < 3; ++k) {
    c->wall_velocity[k] =
        c->wall < 0 ? 0 : step.wall_velocity[k] + p.speeds_of_walls[3 * wall + k];
  }
  const double distance = set_normal(&p, &step, c, position, later);
  set_contact_arms(&p, c, distance, radius, position, poses);
  double matrix[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  for (int k = 0; k < 2; ++k) {
    if (c->ends[k].particle >= 0) add_mobility(&c->ends[k], motions, matrix);
  }
  for (int k = 0; k < 9; ++k) c->matrix[k] = matrix[k];
  const double3 normal = vector_at(c->normal, 0);
  c->mobility = product(normal, times_of(c->matrix, normal));
  if (step.is_finish) {
    const double3 friction = vector_at(c->friction_impulse, 0);
    store_vector(friction - product(friction, normal) * normal, c->friction_impulse, 0);
    store_vector(impulse_of(c), c->drift, 0);
    store_vector(impulse_of(c), c->earlier, 0);
    if (c->is_steady) start_contact(c, step.dt * vector_at(c->last_finish, 0));
    c->parting = -c->approach > step.slow ? -c->restitution * c->approach : 0;
    return;
  }
  // See remaining_overlap() of core/contact/projection/projection.cpp.
  const double overlap = fmax(0.0, c->threshold - distance);
  c->required = c->threshold - 0.99 * fmin(overlap, 1e-6 * c->threshold);
  c->approach = product(slip_of(c, velocity, motions), normal);
  const int other = c->wall >= 0 ? c->wall : WALLS + c->ends[1].particle;
  const int found = find_record(records, state->recorded, c->ends[0].particle, other);
  c->is_steady = found >= 0 ? records[found].is_steady : 0;
  for (int k = 0; k < 3; ++k) {
    c->last_drift[k] = found >= 0 ? records[found].drift[k] : 0;
    c->last_finish[k] = found >= 0 ? records[found].finish[k] : 0;
  }
  store_vector((double3)(0), c->earlier, 0);
  if (c->is_steady) start_contact(c, step.dt * vector_at(c->last_drift, 0));
}

// The position of an end at the end of the step without the velocities, and its late arm.
double3 late_start(const Solids* p, double dt, global ConstraintEnd* end,
                   global const double* start, global const double* later,
                   global const Pose* later_poses, global const RigidMotion* predicted) {
  if (end->rigid < 0) return vector_at(start, end->particle);
  const Pose pose = later_poses[end->rigid];
  const double3 place = vector_at(later, end->particle);
  const double3 arm = place - three(pose.center);
  store_vector(arm, end->late_arm, 0);
  global const RigidMotion* then = predicted + end->rigid;
  return place -
         dt * (vector_at(then->velocity, 0) + cross_product(vector_at(then->spin, 0), arm));
}

// Sets the gaps at the end of the step as functions of the velocities; see Gaps::set_excess().
kernel void set_late_places(const Solids p, const ProjectionStep step,
                            global const Projection* state, global const double* start,
                            global const double* later, global const Pose* later_poses,
                            global const RigidMotion* predicted, global Constraint* contacts) {
  const int n = get_global_id(0);
  if (n >= state->count) return;
  global Constraint* c = contacts + n;
  const double3 first =
      late_start(&p, step.dt, &c->ends[0], start, later, later_poses, predicted);
  if (c->wall >= 0) {
    const double3 normal = vector_at(c->normal, 0);
    store_vector(gap_of_wall(&p, &step, c->wall, first) * normal, c->start, 0);
  } else {
    const double3 second =
        late_start(&p, step.dt, &c->ends[1], start, later, later_poses, predicted);
    store_vector(nearest(&p, first - second), c->start, 0);
  }
}

// Notes whether a gap at the end of the step is too small.
kernel void check_gaps(const Solids p, const ProjectionStep step, global Projection* state,
                       global const double* later, global const Constraint* contacts) {
  const int n = get_global_id(0);
  if (n >= state->count) return;
  global const Constraint* c = contacts + n;
  const double3 x = vector_at(later, c->ends[0].particle);
  double gap = 0;
  if (c->wall >= 0) {
    gap = gap_of_wall(&p, &step, c->wall, x);
  } else {
    const double3 way = nearest(&p, x - vector_at(later, c->ends[1].particle));
    gap = sqrt(product(way, way));
  }
  if (!(gap - c->threshold >= -1e-6 * c->threshold)) atomic_or(&state->unmet, 1);
}

// Ends a round of a solve. An island without a solution is a fault, because only the CPU has another
// method for it.
kernel void end_round(global Projection* state, global int* status) {
  if (get_global_id(0) != 0) return;
  if (state->unsolved) atomic_or(status + kFault, 1);
  state->all_iterations += state->iterations;
  state->iterations = 0;
}

// Begins another round.
kernel void clear_round(global Projection* state) {
  if (get_global_id(0) != 0) return;
  state->unsolved = 0;
  state->unmet = 0;
}

int number_of_end(int free, global const ConstraintEnd* end) {
  return end->rigid < 0 ? end->particle : free + end->rigid;
}

double size_of(double3 v) {
  return sqrt(product(v, v));
}

// Notes which free particles and rigid bodies had an impact.
kernel void find_hits(const double slow, const int free, global const Projection* state,
                      global const Constraint* contacts, global int* is_hit) {
  const int n = get_global_id(0);
  if (n >= state->count) return;
  global const Constraint* c = contacts + n;
  if (!c->is_present || -c->approach <= slow) return;
  for (int k = 0; k < 2; ++k) {
    global const ConstraintEnd* end = &c->ends[k];
    if (end->inverse_mass > 0) atomic_or(is_hit + number_of_end(free, end), 1);
  }
}

// Stores the forces of the contacts, see record().
kernel void record_contacts(const double dt, const int free, global Projection* state,
                            global const Constraint* contacts, global const int* is_hit,
                            global ContactRecord* records) {
  const int n = get_global_id(0);
  if (n == 0) state->recorded = state->count;
  if (n >= state->count) return;
  global const Constraint* c = contacts + n;
  const double3 drift = vector_at(c->drift, 0) / dt;
  const double3 finish = (impulse_of(c) - vector_at(c->drift, 0)) / dt;
  global ContactRecord* record = records + n;
  store_vector(drift, record->drift, 0);
  store_vector(finish, record->finish, 0);
  record->particle = c->ends[0].particle;
  record->other = c->wall >= 0 ? c->wall : WALLS + c->ends[1].particle;
  bool is_calm = true;
  for (int k = 0; k < 2; ++k) {
    global const ConstraintEnd* end = &c->ends[k];
    if (end->inverse_mass > 0) is_calm &= !is_hit[number_of_end(free, end)];
  }
  record->is_steady = is_calm || (size_of(drift) <= 2 * size_of(vector_at(c->last_drift, 0)) &&
                                  size_of(finish) <= 2 * size_of(vector_at(c->last_finish, 0)));
  record->is_present = c->is_present;
}
