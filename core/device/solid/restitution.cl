// The mobilities of simultaneous contacts, see find_contact_mobilities() of
// core/contact/restitution.h.

#ifdef VAT_CONTACT_TERMS

// The sum of the normals of the contacts of each particle, in the order of particles.
kernel void find_contact_directions(
    const Solids p, global const int* begins, global const int* order, global const double* sorted,
    global const double* position, global const double* predicted, global const double* spins,
    global const double* mass, global const double* radius, global const int* body_of,
    global const Body* bodies, global const ContactLaw* laws, global const uint* exclusion_begin,
    global const uint* exclusions, global double* direction) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  Target t =
      target_at(&p, i, place_of_solid(&p, position, i), predicted, spins, mass, radius, body_of, 0);
  t.sums_directions = 1;
  if (p.reach > 0) {
    const ContactColumns columns = {begins, order, sorted, predicted, predicted, spins,
                                    spins, mass, radius, body_of, bodies, laws,
                                    exclusion_begin, exclusions};
    const ContactLists none = {0, 0};
    add_contacts(&p, &columns, &none, &t);
  }
  add_walls(&p, laws[p.materials * p.materials + p.materials + bodies[t.body].material], &t);
  store_vector(t.force, direction, i);
}

// The changes of the linear and angular velocity of each rigid body by unit impulses of its contacts.
// One group for each body.
kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void push_bodies_by_contacts(
    global const Rigid* rigid, global const Pose* poses, global const double* position,
    global const double* direction, global double* changes) {
  local double4 forces[GROUP];
  local double4 torques[GROUP];
  const int b = get_group_id(0);
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const Resultant all =
      resultant_of(forces, torques, &body, three(pose.center), position, direction, 0, 0);
  if (get_local_id(0) != 0) return;
  store_vector(by_mass(&body, all.force), changes, 2 * b);
  store_vector(by_inertia(&body, &pose, all.torque), changes, 2 * b + 1);
}

kernel void find_contact_mobilities(const Solids p, global const double* mobility,
                                    global const int* rigid_of, global const Rigid* rigid,
                                    global const Pose* poses, global const double* position,
                                    global const double* direction, global const double* changes,
                                    global Mobility* mobilities) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  Mobility own;
  own.inverse_mass = mobility[i];
  for (int k = 0; k < 9; ++k) own.turns[k] = 0;
  double3 shared = mobility[i] * vector_at(direction, i);
  if (i >= p.free) {
    const int b = rigid_of[i - p.free];
    const Rigid body = rigid[b];
    const Pose pose = poses[b];
    const double3 arm = vector_at(position, i) - three(pose.center);
    shared = vector_at(changes, 2 * b) + cross_product(vector_at(changes, 2 * b + 1), arm);
    own.inverse_mass = body.is_held ? 0 : body.inverse_mass;
    const double* principal = body.principal_axes;
    const double4 axes = quaternion_product(
        orientation_of(&pose), (double4)(principal[0], principal[1], principal[2], principal[3]));
    for (int axis = 0; axis < 3 && !body.is_held; ++axis) {
      const double3 unit = (double3)(axis == 0, axis == 1, axis == 2);
      const double3 turn =
          sqrt(body.inverse_moments[axis]) * cross_product(turn_by(axes, unit), arm);
      own.turns[3 * axis] = turn.x;
      own.turns[3 * axis + 1] = turn.y;
      own.turns[3 * axis + 2] = turn.z;
    }
  }
  own.shared[0] = shared.x;
  own.shared[1] = shared.y;
  own.shared[2] = shared.z;
  mobilities[i] = own;
}

#endif
