// Limits of adaptive steps by solids, see core/stepping/control/step_control.h and
// step_control_contacts.h. The names are those of these headers.

typedef struct {
  double longest;
  double gained_speed;
  double gained_in_approach;
  double approach_of_liquid;
  double reach;
  double vat_speed;
  double scene_step;
  double travel_share;
  double margin;
  double phase;
  double full_amplitude;
  double greatest_turn;
  int damping_limits;
  int padding;
} StepSearch;

// Symmetric matrices have the components xx, xy, xz, yy, yz, zz.
typedef struct {
  double stiffness[6];
  double damping[6];
  double time;
  double speed;
  double threshold;
  double padding;
} Prediction;

// The greatest way of solid particles by which they can approach others in a step.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_ways(
    const Solids p, const StepSearch search, global const double* velocity,
    global const int* body_of, global const Body* bodies, global double4* partial) {
  local double4 sums[GROUP];
  const int i = get_global_id(0);
  double4 own = 0;
  if (i < p.count) {
    const double3 v = vector_at(velocity, i);
    const double speed = sqrt(product(v, v)) + search.gained_in_approach;
    own.w = fmin(speed * search.longest, search.travel_share * bodies[body_of[i]].travel);
  }
  write_partial(sums, own, partial);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_approach(
    const StepSearch search, const int groups, global const double4* partial,
    global double* approach) {
  local double4 sums[GROUP];
  const double4 total = sum_partial(sums, groups, partial);
  if (get_local_id(0) == 0) *approach = 2 * greater(total.w, search.approach_of_liquid);
}

// Adds a connection along the normal n, see look_at().
void add_prediction(double stiffness, double damping, double sticking, double share,
                    double threshold, double time, double3 normal, double speed,
                    Prediction* sum) {
  const double n[3] = {normal.x, normal.y, normal.z};
  int entry = 0;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column, ++entry) {
      const double along = n[row] * n[column];
      sum->stiffness[entry] += share * stiffness * along;
      sum->damping[entry] +=
          share * (damping * along + sticking * ((row == column ? 1 : 0) - along));
    }
  }
  sum->time = fmin(sum->time, time);
  sum->speed = fmax(sum->speed, speed);
  sum->threshold = fmin(sum->threshold, threshold);
}

double time_to_touch(double gap, double approach) {
  return gap <= 0 ? 0 : gap / fmax(approach, DBL_MIN);
}

bool acts(ContactLaw law) {
  return law.stiffness > 0 || law.damping > 0;
}

// Sets the stiffness of a layer, and the damping of a restitution. `nearest` is the least distance in
// the step.
void predict_terms(ContactLaw* law, double threshold, double nearest, double mobility) {
  if (HAS_TERMS && law->layer > 0) {
    law->stiffness = greatest_layer_slope(*law, threshold, clamp(nearest, 0.0, threshold));
  } else if (HAS_TERMS && law->damping_ratio > 0) {
    law->damping = damping_for(law->damping_ratio, law->stiffness, mobility);
  }
}

// Adds the contacts with other particles, see look_at_pairs().
void look_at_pairs(const Solids* p, const StepSearch* search, double approach,
                   global const int* begins, global const int* order,
                   global const double* sorted, global const double* velocity,
                   global const double* mass, global const double* mobility,
                   global const double* radius, global const int* body_of,
                   global const Body* bodies, global const ContactLaw* laws,
                   global const uint* exclusion_begin, global const uint* exclusions, int i,
                   double3 own, Prediction* sum) {
  const int my_body = body_of[i];
  const Body mine = bodies[my_body];
  const double untouched = mine.touches_itself ? -1 : my_body;
  const double radius_of_search = search->reach + approach;
  const double3 v = vector_at(velocity, i);
  FOR_EACH_ROW_OF_SOLIDS(p, own, radius_of_search, begins, {
    FOR_EACH_NEAR(p, sorted, begin, end, own, shift, radius_of_search * radius_of_search,
                  untouched, {
      const int j = order[slot];
      if (j == i) continue;
      const double3 way = own - sorted_at(p, sorted, slot);
      const double3 x = way + shift;
      const double square = product(x, x);
      const int body = body_of[j];
      const bool is_own = body == my_body;
      ContactLaw law = laws[is_own ? p->materials * p->materials + mine.material
                                   : mine.material * p->materials + bodies[body].material];
      const double threshold = threshold_of(law, radius[i] + radius[j]);
      const double notice = threshold + approach;
      if (!acts(law) || !(square < notice * notice)) continue;
      if (is_own && is_excluded(exclusion_begin, exclusions, i, j)) continue;
      const double r = sqrt(square);
      const double3 relative = v - vector_at(velocity, j);
      const double speed = sqrt(product(relative, relative));
      const double time = time_to_touch(r - threshold, speed + search->gained_speed);
      if (time > search->longest) continue;
      predict_terms(&law, threshold, r - (speed + search->gained_speed) * search->longest,
                    mobility[i] + mobility[j]);
      const double3 n = direction_of(p, x, r, i, j);
      const double sticking =
          law.friction > 0 ? sqrt(law.stiffness * (mass[i] * mass[j] / (mass[i] + mass[j]))) : 0;
      add_prediction(law.stiffness, law.damping, sticking, 1 + sqrt(mobility[j] / mobility[i]),
                     threshold, time, n, r > 0 ? fabs(product(relative, n)) : speed, sum);
    })
  })
}

// Adds the contacts with walls, see look_at_walls().
void look_at_walls(const Solids* p, const StepSearch* search, ContactLaw of_wall, double mass,
                   double mobility, double radius, double3 own, double3 velocity,
                   Prediction* sum) {
  if (!acts(of_wall)) return;
  const double threshold = threshold_of(of_wall, radius);
  const double sticking = of_wall.friction > 0 ? sqrt(of_wall.stiffness * mass) : 0;
  const double at[3] = {own.x, own.y, own.z};
  const double v[3] = {velocity.x, velocity.y, velocity.z};
  for (int wall = 0; wall < 6; ++wall) {
    if (!((p->walls >> wall) & 1)) continue;
    const int axis = wall / 2;
    const double side = wall % 2 == 0 ? 1 : -1;
    const double speed = -side * v[axis];
    const double gap = distance_from_wall(p, wall, at[axis]) - threshold;
    const double approach = fmax(0.0, speed + search->gained_speed + search->vat_speed);
    const double time = time_to_touch(gap, approach);
    if (time > search->longest) continue;
    const double3 n = (double3)(axis == 0 ? side : 0, axis == 1 ? side : 0, axis == 2 ? side : 0);
    ContactLaw law = of_wall;
    predict_terms(&law, threshold, gap + threshold - approach * search->longest, mobility);
    add_prediction(law.stiffness, law.damping, sticking, 1, threshold, time, n,
                   fabs(speed + side * p->wall_velocity[axis]), sum);
  }
}

// Finds the contacts of particles of rigid bodies that act or may soon act. `mobility` has the inverse
// masses of contacts.
kernel void predict_contacts(const Solids p, const StepSearch search,
                             global const double* approach, global const int* begins,
                             global const int* order, global const double* sorted,
                             global const double* velocity, global const double* mass,
                             global const double* mobility, global const double* radius,
                             global const int* body_of, global const Body* bodies,
                             global const ContactLaw* laws, global const uint* exclusion_begin,
                             global const uint* exclusions, global Prediction* predictions) {
  const int slot = get_global_id(0);
  if (slot >= p.count) return;
  const int i = order[slot];
  if (i < p.free) return;
  Prediction sum;
  for (int entry = 0; entry < 6; ++entry) sum.stiffness[entry] = sum.damping[entry] = 0;
  sum.time = sum.threshold = INFINITY;
  sum.speed = sum.padding = 0;
  if (mobility[i] > 0) {
    const double3 own = sorted_at(&p, sorted, slot);
    if (search.reach > 0) {
      look_at_pairs(&p, &search, *approach, begins, order, sorted, velocity, mass,
                    mobility, radius, body_of, bodies, laws, exclusion_begin, exclusions, i, own,
                    &sum);
    }
    const int of_wall =
        p.materials * p.materials + p.materials + bodies[body_of[i]].material;
    look_at_walls(&p, &search, laws[of_wall], mass[i], mobility[i], radius[i], own,
                  vector_at(velocity, i), &sum);
  }
  predictions[i - p.free] = sum;
}

// The part of one particle in the sums of RigidLoad. `matrix` is symmetric.
void add_load(const double* matrix, double3 arm, double* linear, double* mixed, double* angular) {
  const double k[9] = {matrix[0], matrix[1], matrix[2], matrix[1], matrix[3],
                       matrix[4], matrix[2], matrix[4], matrix[5]};
  const double c[9] = {0, -arm.z, arm.y, arm.z, 0, -arm.x, -arm.y, arm.x, 0};
  double turned[9];
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      double sum = 0;
      for (int n = 0; n < 3; ++n) sum += c[3 * row + n] * k[3 * n + column];
      turned[3 * row + column] = sum;
      linear[3 * row + column] += k[3 * row + column];
      mixed[3 * row + column] += sum;
    }
  }
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      for (int n = 0; n < 3; ++n) {
        angular[3 * row + column] += turned[3 * row + n] * c[3 * column + n];
      }
    }
  }
}

// See greatest_eigenvalue().
double eigenvalue_bound(double* matrix) {
  double trace = 0;
  for (int n = 0; n < 6; ++n) trace += matrix[7 * n];
  if (!(trace > 0)) return 0;
  for (int n = 0; n < 36; ++n) matrix[n] /= trace;
  for (int squaring = 0; squaring < 3; ++squaring) {
    double square[36];
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        double sum = 0;
        for (int n = 0; n < 6; ++n) sum += matrix[6 * row + n] * matrix[6 * n + column];
        square[6 * row + column] = sum;
      }
    }
    for (int n = 0; n < 36; ++n) matrix[n] = square[n];
  }
  double last = 0;
  for (int n = 0; n < 6; ++n) last += matrix[7 * n];
  return trace * sqrt(sqrt(sqrt(last)));
}

// The bound RigidLoad::greatest(). The columns of `turning` are turned principal axes times the roots
// of the inverse moments.
double greatest_load(const double* linear, const double* mixed, const double* angular,
                     double inverse_mass, const double* turning) {
  double matrix[36];
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      double scaled = 0;
      double turned = 0;
      for (int n = 0; n < 3; ++n) {
        scaled += turning[3 * n + row] * mixed[3 * n + column];
        for (int m = 0; m < 3; ++m) {
          turned += turning[3 * n + row] * angular[3 * n + m] * turning[3 * m + column];
        }
      }
      scaled *= sqrt(inverse_mass);
      matrix[6 * row + column] = inverse_mass * linear[3 * row + column];
      matrix[6 * (row + 3) + column] = scaled;
      matrix[6 * column + row + 3] = scaled;
      matrix[6 * (row + 3) + column + 3] = turned;
    }
  }
  return eigenvalue_bound(matrix);
}

// The step for contacts with the bounds omega2 and rate, see allowed_step().
double step_of_contacts(const StepSearch* search, double time, double speed, double threshold,
                        double omega2, double rate) {
  const double both = sqrt(omega2 + rate * rate);
  if (both == 0) return INFINITY;
  const double share = fmin(1.0, speed / both / (search->full_amplitude * threshold));
  const double resolving = search->phase / (both * sqrt(share));
  const double damped = search->damping_limits ? rate : 0;
  const double root = damped + sqrt(damped * damped + 4 * omega2);
  const double safe = root > 0 ? search->margin * (4 / root) : INFINITY;
  return fmax(time, fmin(safe, resolving));
}

// See travel_time(), without acceleration.
double step_of_motion(const StepSearch* search, const Rigid* body, const Pose* pose) {
  const double3 momentum = three(pose->momentum);
  const double3 spin = spin_of(body, orientation_of(pose), three(pose->angular_momentum));
  const double turning = sqrt(product(spin, spin));
  const double speed = body->inverse_mass * sqrt(product(momentum, momentum)) +
                       body->extent * turning;
  const double travel = search->travel_share * body->travel / speed;
  const double turn = turning > 0 ? search->greatest_turn / turning : INFINITY;
  return fmin(fmin(search->scene_step, travel), turn);
}

double4 sum_of(double4 a, double4 b) {
  return a + b;
}

// The sums of a body's contacts: two loads of 27 numbers.
#define LOAD 27
#define LOADS 56  // a multiple of 4

// Finds the step that each rigid body allows. One group for each body.
kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void limit_steps_of_bodies(
    const StepSearch search, const int free, global const Rigid* rigid, global const Pose* poses,
    global const double* position, global const Prediction* predictions, global double4* steps) {
  local double4 sums[GROUP];
  const int b = get_group_id(0);
  const Rigid body = rigid[b];
  const Pose pose = poses[b];
  const int count = body.end - body.begin;
  const int first = LANES * get_local_id(0);
  double loads[LANES][LOADS];
  double4 nearest[LANES];  // the opposite of time and threshold, and speed
  for (int lane = 0; lane < LANES; ++lane) {
    for (int n = 0; n < LOADS; ++n) loads[lane][n] = 0;
    nearest[lane] = (double4)(-INFINITY, -INFINITY, 0, 0);
    for (int e = body.begin + first + lane; e < body.end; e += GROUP) {
      const Prediction own = predictions[e - free];
      if (own.time == INFINITY) continue;
      const double3 arm = vector_at(position, e) - three(pose.center);
      double* load = loads[lane];
      add_load(own.stiffness, arm, load, load + 9, load + 18);
      load += LOAD;
      add_load(own.damping, arm, load, load + 9, load + 18);
      nearest[lane] =
          greatest_of(nearest[lane], (double4)(-own.time, -own.threshold, own.speed, 0));
    }
  }
  double load[LOADS];
  for (int part = 0; part < LOADS; part += 4) {
    for (int lane = 0; lane < LANES; ++lane) {
      const double* own = loads[lane] + part;
      sums[first + lane] = (double4)(own[0], own[1], own[2], own[3]);
    }
    COMBINE_SOME(sums, count, sum_of)
    const double4 total = sums[0];
    load[part] = total.x;
    load[part + 1] = total.y;
    load[part + 2] = total.z;
    load[part + 3] = total.w;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  for (int lane = 0; lane < LANES; ++lane) sums[first + lane] = nearest[lane];
  COMBINE_SOME(sums, GROUP, greatest_of)
  if (get_local_id(0) != 0) return;
  const double time = -sums[0].x;
  double step = step_of_motion(&search, &body, &pose);
  if (!body.is_held && time < INFINITY) {
    const double* principal = body.principal_axes;
    const double4 axes = quaternion_product(
        orientation_of(&pose), (double4)(principal[0], principal[1], principal[2], principal[3]));
    double turning[9];
    for (int axis = 0; axis < 3; ++axis) {
      const double3 unit = (double3)(axis == 0, axis == 1, axis == 2);
      const double3 column = sqrt(body.inverse_moments[axis]) * turn_by(axes, unit);
      turning[axis] = column.x;
      turning[3 + axis] = column.y;
      turning[6 + axis] = column.z;
    }
    const double omega2 = greatest_load(load, load + 9, load + 18, body.inverse_mass, turning);
    const double rate =
        greatest_load(load + LOAD, load + LOAD + 9, load + LOAD + 18, body.inverse_mass, turning);
    step = fmin(step, step_of_contacts(&search, time, sums[0].z, -sums[0].y, omega2, rate));
  }
  steps[b] = (double4)(0, 0, 0, -step);
}

// The least of the steps of bodies.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_least_step(
    const int count, global const double4* steps, global double* least) {
  local double4 maxima[GROUP];
  double4 own = (double4)(0, 0, 0, -INFINITY);
  for (int n = get_local_id(0); n < count; n += GROUP) own = greatest_of(own, steps[n]);
  const double4 greatest = maximum_of_group(maxima, own);
  if (get_local_id(0) == 0) *least = -greatest.w;
}
