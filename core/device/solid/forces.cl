// Forces on particles of deformable and rigid bodies: springs, cells with a bulk modulus, contacts, and walls.
// Each particle sums its forces in a fixed order: contacts in the order of cells, and springs in
// the order of their other ends.

typedef struct {
  uint other;
  double stiffness;
  double damping;
  double rest_length;
} SpringEnd;

typedef struct {
  uint corners[8];
  double volume;
  double bulk_modulus;
} VolumeCell;

// The particle whose forces are summed. `stiffness` and `damping` are those of ContactLoad. If
// `is_change` is set, the sum is the change of the forces by a change w of all velocities, for
// constant positions and drag coefficients; see DampingMatrix. If `sums_directions` is set, it is the
// sum of the normals of the contacts. `mobilities` are those of all particles, in scenes with
// restitution.
typedef struct {
  int index;
  int body;
  int is_change;
  int is_rigid;
  int sums_directions;
  global const Mobility* mobilities;
  double mass;
  double radius;
  double3 x;
  double3 v;
  double3 w;
  double3 spin;
  double3 spin_change;
  double3 force;
  double3 torque;
  double stiffness;
  double damping;
} Target;

// A unit vector for particles at the same position, see coincident_direction().
double3 direction_if_coincident(uint i, uint j, int dimensions) {
  ulong bits = ((ulong)min(i, j) << 32 | max(i, j)) * 0x9e3779b97f4a7c15UL;
  double d[3];
  for (int axis = 0; axis < 3; ++axis) {
    bits ^= bits >> 29;
    bits *= 0xbf58476d1ce4e5b9UL;
    d[axis] = (double)(bits >> 40) - 8388608.0 + 0.5;
  }
  if (dimensions == 2) d[1] = 0;
  const double3 way = (double3)(d[0], d[1], d[2]);
  const double3 unit = way / sqrt(product(way, way));
  return i < j ? unit : -unit;
}

INLINE double3 direction_of(const Solids* p, double3 x, double r, int i, int j) {
  return r > 0 ? x * (1 / r) : direction_if_coincident(p->first + i, p->first + j, p->dimensions);
}

// The drag / slip speed of friction with the rate `sticking`, see Friction::drag().
INLINE double friction_drag(double coefficient, double sticking, double push, double3 slip) {
  const double limit = coefficient * push;
  const double speed = sqrt(product(slip, slip));
  return sticking * speed > limit ? limit / speed : sticking;
}

// The other particle of a contact. `w` and `spin_change` are 0 if the target's is_change is not set.
typedef struct {
  int index;
  int is_rigid;
  double mass;
  double radius;
  double3 v;
  double3 w;
  double3 spin;
  double3 spin_change;
} Other;

INLINE Other other_at(const Solids* p, int is_change, int j, int body, global const double* predicted,
               global const double* change, global const double* spins,
               global const double* spin_changes, global const double* mass,
               global const double* radius) {
  const double3 zero = 0;
  const Other o = {j, j >= p->free, mass[j], radius[j], vector_at(predicted, j),
                   is_change ? vector_at(change, j) : zero, vector_at(spins, body),
                   is_change ? vector_at(spin_changes, body) : zero};
  return o;
}

// Vectors from the centres of two particles to their friction point, see contact_arms().
typedef struct {
  double3 mine;
  double3 its;
} Arms;

INLINE Arms arms_of(const Target* t, const Other* o, double3 way) {
  Arms arms = {(double3)(0), (double3)(0)};
  if (!t->is_rigid && !o->is_rigid) return arms;
  const double own = !t->is_rigid ? 0 : o->is_rigid ? t->radius / (t->radius + o->radius) : 1;
  arms.mine = -own * way;
  arms.its = (1 - own) * way;
  return arms;
}

INLINE double3 across(double3 v, double3 n) {
  return v - product(v, n) * n;
}

// Adds the contact with another particle at the distance r; see add_contacts(). Returns false if the
// contact does not act. A layer has no damper, so that solves for damping do not need it.
INLINE bool add_contact(const Solids* p, ContactLaw law, const Other* o, double3 x, double r,
                 double threshold, Target* t) {
  const double3 n = direction_of(p, x, r, t->index, o->index);
  if (HAS_TERMS && t->sums_directions) {
    if (law.stiffness > 0) t->force += n;
    return false;
  }
  if (HAS_TERMS && law.layer > 0) {
    if (!t->is_change) t->force += layer_push(law, threshold, r) * n;
    t->stiffness += 2 * greatest_layer_slope(law, threshold, r);
    return false;
  }
  if (HAS_TERMS && law.damping_ratio > 0) {
    const double mobility = mobility_along(t->mobilities + t->index, n) +
                            mobility_along(t->mobilities + o->index, -n);
    law.damping = damping_for(law.damping_ratio, law.stiffness, mobility);
  }
  const double3 relative = t->v - o->v;
  const double speed = product(relative, n);
  const double push = law.stiffness * (threshold - r) - law.damping * speed;
  if (push <= 0) return false;
  t->force +=
      t->is_change ? -(law.damping * product(t->w - o->w, n)) * n : push * n;
  double sticking = 0;
  if (law.friction > 0) {
    sticking = sqrt(law.stiffness * (t->mass * o->mass / (t->mass + o->mass)));
    const Arms arms = arms_of(t, o, r * n);
    const double3 slip = relative - speed * n + cross_product(t->spin, arms.mine) -
                         cross_product(o->spin, arms.its);
    const double drag = friction_drag(law.friction, sticking, push, slip);
    const double3 change = t->w - o->w + cross_product(t->spin_change, arms.mine) -
                           cross_product(o->spin_change, arms.its);
    const double3 friction = -drag * (t->is_change ? across(change, n) : slip);
    t->force += friction;
    t->torque += cross_product(arms.mine, friction);
  }
  t->stiffness += 2 * law.stiffness;
  t->damping += 2 * fmax(law.damping, sticking);
  return true;
}

// Whether two particles of one body never touch.
bool is_excluded(global const uint* begins, global const uint* excluded, int i, uint j) {
  uint low = begins[i];
  uint high = begins[i + 1];
  while (low < high) {
    const uint middle = (low + high) / 2;
    if (excluded[middle] < j) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low < begins[i + 1] && excluded[low] == j;
}

// The columns that contacts depend on. `change` and `spin_changes` are those of Target::is_change.
typedef struct {
  global const int* begins;
  global const int* order;
  global const double* sorted;
  global const double* predicted;
  global const double* change;
  global const double* spins;
  global const double* spin_changes;
  global const double* mass;
  global const double* radius;
  global const int* body_of;
  global const Body* bodies;
  global const ContactLaw* laws;
  global const uint* exclusion_begin;
  global const uint* exclusions;
} ContactColumns;

// The contacts that act on each particle, for solves that use them again. They have the order of
// cells. Contact k of particle i is near[k * p.count + i]: the slot of the other particle, and above
// it the image. Lists of more than MOST_CONTACTS are not complete.
typedef struct {
  int is_kept;
  global uint* near;
} ContactLists;

#define MOST_CONTACTS 16
#define IMAGE_BIT 27
#define WALLS_ACT 0x100000

// The number of an image from 0 to 26, and the shift to it.
INLINE uint image_of(double3 shift) {
  const long3 signs = (shift < 0) - (shift > 0);
  return 13 + 9 * signs.x + 3 * signs.y + signs.z;
}

INLINE double3 shift_to(const Solids* p, uint image) {
  return (double3)(((int)(image / 9) - 1) * p->period[0], ((int)(image / 3 % 3) - 1) * p->period[1],
                   ((int)(image % 3) - 1) * p->period[2]);
}

// Adds the contact with the particle in a slot. Returns false if there is none, or if it does not act.
INLINE bool add_contact_at(const Solids* p, const ContactColumns* c, int slot, double3 shift,
                           Target* t) {
  const int j = c->order[slot];
  const int body = c->body_of[j];
  const bool is_own = body == t->body;
  if (j == t->index) return false;
  const int material = c->bodies[t->body].material;
  const int other = c->bodies[body].material;
  // Within a liquid, there are other forces.
  if (t->index < p->liquids && j < p->liquids && material == other) return false;
  // The laws within bodies follow those between materials.
  const ContactLaw law = c->laws[is_own ? p->materials * p->materials + material
                                        : material * p->materials + other];
  const double threshold = threshold_of(law, t->radius + c->radius[j]);
  const double3 x = t->x - sorted_at(p, c->sorted, slot) + shift;
  const double square = product(x, x);
  if (!(square < threshold * threshold)) return false;
  if (is_own && is_excluded(c->exclusion_begin, c->exclusions, t->index, j)) return false;
  const Other o = other_at(p, t->is_change, j, body, c->predicted, c->change, c->spins,
                           c->spin_changes, c->mass, c->radius);
  return add_contact(p, law, &o, x, sqrt(square), threshold, t);
}

// Adds the contacts with the particles in the cells around the target. Returns their number.
INLINE int add_contacts(const Solids* p, const ContactColumns* c, const ContactLists* lists,
                        Target* t) {
  const double untouched = c->bodies[t->body].touches_itself ? -1 : t->body;
  int count = 0;
  FOR_EACH_ROW_OF_SOLIDS(p, t->x, p->reach, c->begins, {
    FOR_EACH_NEAR(p, c->sorted, begin, end, t->x, shift, p->reach * p->reach, untouched, {
      if (!add_contact_at(p, c, slot, shift, t)) continue;
      if (lists->is_kept && count < MOST_CONTACTS) {
        lists->near[count * p->count + t->index] = slot | image_of(shift) << IMAGE_BIT;
      }
      ++count;
    })
  })
  return count;
}

// Adds the springs of the target, see add_spring_forces(). In a periodic world, they do not cross its
// sides. `ways` receives the directions of the springs if it is not null.
INLINE void add_springs(const Solids* p, global const uint* begins, global const SpringEnd* ends,
                 global const double* position, global const double* velocity,
                 global double* ways, Target* t) {
  const double3 own = vector_at(position, t->index);
  const uint end = begins[t->index + 1];
  for (uint s = begins[t->index]; s < end; ++s) {
    const SpringEnd spring = ends[s];
    const double3 x = own - vector_at(position, spring.other);
    const double r = sqrt(product(x, x));
    const double3 n = direction_of(p, x, r, t->index, spring.other);
    if (ways != 0) store_vector(n, ways, s);
    const double speed = product(t->v - vector_at(velocity, spring.other), n);
    const double elastic = spring.stiffness * (spring.rest_length - r);
    t->force += (elastic - spring.damping * speed) * n;
  }
}

// The other three corners of the face of the corner `c` across `axis`, see cell::face_of().
void find_face(uint c, uint axis, uint* face) {
  const uint i = 1u << (axis + 1) % 3;
  const uint j = 1u << (axis + 2) % 3;
  const bool is_odd = ((c ^ c >> 1 ^ c >> 2) & 1) != 0;
  face[0] = is_odd ? c ^ i : c ^ j;
  face[1] = c ^ i ^ j;
  face[2] = is_odd ? c ^ j : c ^ i;
}

double3 quarter_turn(double3 v) {
  return (double3)(v.z, 0, -v.x);
}

// The derivative of the volume with respect to the position of the corner `c`, see cell_slope().
double3 slope_of_volume(global const double* position, const VolumeCell* cell, uint c,
                        int dimensions) {
  if (dimensions == 2) {
    const bool is_outer = c == 0 || c == 3;
    const uint to = cell->corners[is_outer ? 2 : 0];
    const uint from = cell->corners[is_outer ? 1 : 3];
    const double3 across = vector_at(position, to) - vector_at(position, from);
    return quarter_turn(across) * (c == 3 || c == 2 ? 0.5 : -0.5);
  }
  const double3 own = vector_at(position, cell->corners[c]);
  double3 sum = 0;
  for (uint axis = 0; axis < 3; ++axis) {
    uint face[3];
    find_face(c, axis, face);
    const double3 a = vector_at(position, cell->corners[face[0]]) - own;
    const double3 b = vector_at(position, cell->corners[face[1]]) - own;
    const double3 d = vector_at(position, cell->corners[face[2]]) - own;
    sum += cross_product(a, b) + cross_product(b, d) + cross_product(a, d);
  }
  return sum / 12;
}

// The volume of a cell, see cell_volume().
double volume_of(global const double* position, const VolumeCell* cell, int dimensions) {
  const double3 origin = vector_at(position, cell->corners[0]);
  if (dimensions == 2) {
    const double3 across =
        vector_at(position, cell->corners[2]) - vector_at(position, cell->corners[1]);
    return product(vector_at(position, cell->corners[3]) - origin, quarter_turn(across)) / 2;
  }
  double sum = 0;
  for (uint axis = 0; axis < 3; ++axis) {
    for (uint c = 0; c < 8; c += 7) {
      uint face[3];
      find_face(c, axis, face);
      const double3 q = vector_at(position, cell->corners[c]) - origin;
      const double3 a = vector_at(position, cell->corners[face[0]]) - origin;
      const double3 b = vector_at(position, cell->corners[face[1]]) - origin;
      const double3 d = vector_at(position, cell->corners[face[2]]) - origin;
      const double3 across = cross_product(b, d);
      sum += product(q, cross_product(a, b) + across + cross_product(a, d)) + product(a, across);
    }
  }
  return sum / 12;
}

kernel void find_cell_pressure(const int count, const int dimensions,
                               global const double* position, global const VolumeCell* cells,
                               global double* pressure) {
  const int k = get_global_id(0);
  if (k >= count) return;
  const VolumeCell cell = cells[k];
  const double volume = volume_of(position, &cell, dimensions);
  pressure[k] = cell.bulk_modulus * (1 - volume / cell.volume);
}

// Adds the forces of the cells of the target, see add_cell_forces().
INLINE void add_cells(const Solids* p, global const uint* begins, global const uint2* corners,
               global const VolumeCell* cells, global const double* pressure,
               global const double* position, Target* t) {
  double3 sum = 0;
  for (uint n = begins[t->index]; n < begins[t->index + 1]; ++n) {
    const uint2 corner = corners[n];
    const VolumeCell cell = cells[corner.x];
    sum += pressure[corner.x] * slope_of_volume(position, &cell, corner.y, p->dimensions);
  }
  t->force += sum;
}

// Adds the forces of the walls, see add_wall_forces(). Returns whether a wall acts.
INLINE bool add_walls(const Solids* p, ContactLaw law, Target* t) {
  const double threshold = threshold_of(law, t->radius);
  const double sticking = law.friction > 0 ? sqrt(law.stiffness * t->mass) : 0;
  const double at[3] = {t->x.x, t->x.y, t->x.z};
  const double v[3] = {t->v.x, t->v.y, t->v.z};
  const double w[3] = {t->w.x, t->w.y, t->w.z};
  int count = 0;
  double stiffness = 0;
  double damping = 0;
  for (int wall = 0; wall < 6; ++wall) {
    const int axis = wall / 2;
    if (!((p->walls >> wall) & 1)) continue;
    const double distance = distance_from_wall(p, wall, at[axis]);
    if (distance >= threshold) continue;
    const double side = wall % 2 == 0 ? 1 : -1;
    const double3 n = (double3)(axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0);
    if (HAS_TERMS && t->sums_directions) {
      if (law.stiffness > 0) t->force += n;
      continue;
    }
    if (HAS_TERMS && law.layer > 0) {
      if (!t->is_change) t->force += layer_push(law, threshold, distance) * n;
      stiffness = fmax(stiffness, greatest_layer_slope(law, threshold, distance));
      ++count;
      continue;
    }
    if (HAS_TERMS && law.damping_ratio > 0) {
      law.damping = damping_for(law.damping_ratio, law.stiffness,
                                mobility_along(t->mobilities + t->index, n));
    }
    const double speed = side * (v[axis] - p->wall_velocity[axis]);
    const double push = law.stiffness * (threshold - distance) - law.damping * speed;
    if (push <= 0) continue;
    ++count;
    stiffness = law.stiffness;
    damping = fmax(damping, law.damping);
    t->force += (t->is_change ? -law.damping * side * w[axis] : push) * n;
    if (!(law.friction > 0)) continue;
    const double3 arm = t->is_rigid ? -distance * n : (double3)(0);
    const double* belt = p->speeds_of_walls + 3 * wall;
    const double3 of_wall = (double3)(p->wall_velocity[0] + belt[0], p->wall_velocity[1] + belt[1],
                                      p->wall_velocity[2] + belt[2]);
    const double3 slip = across(t->v + cross_product(t->spin, arm) - of_wall, n);
    const double drag = friction_drag(law.friction, sticking, push, slip);
    const double3 change = t->w + cross_product(t->spin_change, arm);
    const double3 friction = -drag * (t->is_change ? across(change, n) : slip);
    t->force += friction;
    t->torque += cross_product(arm, friction);
  }
  if (count == 0) return false;
  t->stiffness += stiffness;
  t->damping += fmax(damping, sticking) + (count - 1) * sticking;
  return true;
}

// The greater components of the values of a group.
double2 greatest_of_group(local double2* values, double2 own) {
  values[get_local_id(0)] = own;
  COMBINE_GROUP(values, fmax)
  return values[0];
}

// The bound of the oscillations of a particle with contacts, see find_bound().
INLINE double2 bound_of(const Target* t, double mobility, Body body) {
  if ((t->stiffness == 0 && t->damping == 0) || mobility == 0) return 0;
  return (double2)(body.omega2 + mobility * t->stiffness, body.rate + mobility * t->damping);
}

// A target without forces.
INLINE Target target_at(const Solids* p, int i, double3 x, global const double* predicted,
                 global const double* spins, global const double* mass,
                 global const double* radius, global const int* body_of,
                 global const Mobility* mobilities) {
  const double3 zero = 0;
  const Target t = {i,       body_of[i], 0, i >= p->free,            0,    mobilities,
                    mass[i], radius[i],  x, vector_at(predicted, i), zero, vector_at(spins, body_of[i]),
                    zero,    zero,       zero, 0, 0};
  return t;
}

// The forces in the order of particles, and the torques of friction. `loads` receives the loads of
// the contacts, and `partial` the greatest bounds of free particles in groups. With `keeps_lists`,
// the other columns receive the acting contacts and the directions of springs.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_solid_forces(
    const Solids p, global const int* begins, global const int* order,
    global const double* sorted, global const double* position,
    global const double* predicted, global const double* spins, global const double* mass,
    global const double* mobility, global const double* radius, global const int* body_of,
    global const Body* bodies, global const ContactLaw* laws,
    global const uint* exclusion_begin, global const uint* exclusions,
    global const uint* spring_begin, global const SpringEnd* springs,
    global const uint* cell_begin, global const uint2* corners, global const VolumeCell* cells,
    global const double* pressure, global const Mobility* mobilities, global double* force,
    global double* torque, global double2* loads, global double2* partial, const int keeps_lists,
    global int* contact_counts, global uint* contacts, global double* ways,
    const NearSearch search, global const int* rigid_of, global const double* spheres,
    global const int* near_counts, global const int* near_bodies) {
  local double2 bounds[GROUP];
  const int i = get_global_id(0);
  double2 own = 0;
  if (i < p.count) {
    Target t = target_at(&p, i, place_of_solid(&p, position, i), predicted, spins, mass, radius,
                         body_of, mobilities);
    const Body body = bodies[t.body];
    t.force = t.mass * (double3)(p.gravity[0], p.gravity[1], p.gravity[2]);
    if (p.field_strength > 0) {
      const double3 arm =
          vector_at(position, i) -
          (double3)(p.field_center[0], p.field_center[1], p.field_center[2]);
      t.force -= (t.mass * p.field_strength) * arm;
    }
    int acting = 0;
    const NearBodies near = {spheres, near_counts, near_bodies};
    if (p.reach > 0 && (!search.is_used || may_touch(&search, &near, rigid_of[i], t.x))) {
      const ContactColumns columns = {begins, order, sorted, predicted, predicted, spins, spins, mass,
                               radius, body_of, bodies, laws, exclusion_begin, exclusions};
      const ContactLists lists = {keeps_lists, contacts};
      acting = add_contacts(&p, &columns, &lists, &t);
    }
    if (i < p.implicit) {
      add_springs(&p, spring_begin, springs, position, predicted, keeps_lists ? ways : 0, &t);
    }
    if (i < p.free) {
      add_cells(&p, cell_begin, corners, cells, pressure, position, &t);
    }
    if (p.walls_push) {
      const int of_wall = p.materials * p.materials + p.materials + body.material;
      if (add_walls(&p, laws[of_wall], &t)) acting |= WALLS_ACT;
    }
    if (keeps_lists) contact_counts[i] = acting;
    store_vector(t.force, force, i);
    store_vector(t.torque, torque, i);
    loads[i] = (double2)(t.stiffness, t.damping);
    if (i < p.free) own = bound_of(&t, mobility[i], body);
  }
  const double2 greatest = greatest_of_group(bounds, own);
  if (get_local_id(0) == 0) partial[get_group_id(0)] = greatest;
}

// The greatest bound of all groups and rigid bodies, and at least `least`.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_bound_of_forces(
    const int groups, const int bodies, const double2 least, global const double2* partial,
    global const double2* of_bodies, global double2* bound) {
  local double2 bounds[GROUP];
  double2 own = least;
  for (int n = get_local_id(0); n < groups; n += GROUP) own = fmax(own, partial[n]);
  for (int b = get_local_id(0); b < bodies; b += GROUP) own = fmax(own, of_bodies[b]);
  const double2 greatest = greatest_of_group(bounds, own);
  if (get_local_id(0) == 0) *bound = greatest;
}
