// Bodies with implicit springs, see core/solid/implicit_springs.h, in the phases of spring_system.cl.

// The force at the spring end `e` of particle `k`. Stores its slope.
double3 push_end(const SpringSystem* s, int k, uint e, double half_dt) {
  const SpringEnd spring = s->springs[e];
  const int own = s->all.begin + k;
  const int other = (int)spring.other - s->all.begin;
  const double3 start = vector_at(s->position, k) - vector_at(s->position, other);
  const double3 way = half_dt * (vector_at(s->velocity, k) - vector_at(s->velocity, other));
  const double3 middle = start + way;
  const double3 end = middle + way;
  const double before = sqrt(product(start, start));
  const double after = sqrt(product(end, end));
  const double mean = (before + after) / 2;
  const double length = sqrt(product(middle, middle));
  const double3 n = length > 0 ? middle / length
                               : direction_if_coincident(s->all.first + own,
                                                         s->all.first + spring.other,
                                                         s->all.dimensions);
  const double calming =
      2 * half_dt * spring.damping * (s->mobility[own] + s->mobility[spring.other]);
  const double late = calming * calming / (1 + calming * calming);
  const double stiffness = half_dt * half_dt * spring.stiffness;
  const double strain =
      mean == 0 ? 0 : (mean - spring.rest_length + late * (after - before) / 2) / mean;
  const SpringSlope slope = {{n.x, n.y, n.z},
                             mean == 0 ? stiffness : (1 + late) * stiffness,
                             stiffness * fmax(strain, 0.0)};
  s->slopes[e - s->all.springs_begin] = slope;
  // Two particles at one position are pushed apart as by any spring.
  return mean == 0 ? (spring.stiffness * spring.rest_length) * n
                   : -spring.stiffness * strain * middle;
}

// Computes the remaining impulse dt/2 f - m (v - v0). Returns the part of its square and of that of the
// rounding errors of the forces, in the norm of the inverse masses.
double4 find_residual(const SpringSystem* s, double half_dt) {
  const double rounding = 4 * DBL_EPSILON;
  double4 own = 0;
  FOR_PARTICLES_OF(s, k) {
    const int i = s->all.begin + k;
    double3 r = 0;
    if (s->mobility[i] > 0) {
      double3 force = 0;
      for (uint e = s->spring_begin[i]; e < s->spring_begin[i + 1]; ++e) {
        force += push_end(s, k, e, half_dt);
      }
      const double3 start = vector_at(s->start_velocity, k);
      const double3 x = vector_at(s->position, k);
      r = half_dt * force - s->mass[i] * (vector_at(s->velocity, k) - start);
      const double size = half_dt * s->stiffness[k] * sqrt(product(x, x)) +
                          s->mass[i] * sqrt(product(start, start));
      own.x += s->mobility[i] * product(r, r);
      own.y += rounding * rounding * s->mobility[i] * size * size;
    }
    store_vector(r, s->residual, k);
  }
  return own;
}

void begin_drift(const SpringSystem* s) {
  FOR_PARTICLES_OF(s, k) {
    store_vector(vector_at(s->start_of_drift, s->all.begin + k), s->position, k);
    store_vector(vector_at(s->body_velocity, s->all.begin + k), s->start_velocity, k);
    store_vector((double3)(0), s->mean_velocity, k);
  }
}

// The part of <gained, M gained> of the velocity.
double size_of_gained(const SpringSystem* s) {
  double own = 0;
  FOR_PARTICLES_OF(s, k) {
    const double3 gained = vector_at(s->velocity, k) - vector_at(s->start_velocity, k);
    own += mass_of(s, k) * product(gained, gained);
  }
  return own;
}

void follow_change(const SpringSystem* s, double length, int is_first) {
  FOR_PARTICLES_OF(s, k) {
    const double3 from = vector_at(is_first ? s->velocity : s->last_velocity, k);
    store_vector(from, s->last_velocity, k);
    store_vector(from + length * vector_at(s->change, k), s->velocity, k);
  }
}

double3 middle_of(const SpringSystem* s, int k, double half_dt) {
  return vector_at(s->position, k) + half_dt * vector_at(s->velocity, k);
}

// The part of the sums of mass times position and of masses, at the middle of the drift.
double4 weighted_middle(const SpringSystem* s, double half_dt) {
  double4 own = 0;
  FOR_PARTICLES_OF(s, k) {
    own += (double4)(mass_of(s, k) * middle_of(s, k, half_dt), mass_of(s, k));
  }
  return own;
}

// The part of a moment: the torque that is not 0, and the diagonal and other entries of the inertia.
double4 moment_of(const SpringSystem* s, local const SpringState* q) {
  double4 own = 0;
  FOR_PARTICLES_OF(s, k) {
    if (!(mobility_of(s, k) > 0)) continue;
    const double mass = mass_of(s, k);
    const double3 arm = middle_of(s, k, q->half_dt) - q->center.xyz;
    if (q->moment == 0) {
      const double3 gained = vector_at(s->velocity, k) - vector_at(s->start_velocity, k);
      own.xyz += mass * cross_product(arm, gained);
    } else if (q->moment == 1) {
      own.xyz += mass * (product(arm, arm) - arm * arm);
    } else {
      own.xyz -= mass * (double3)(arm.x * arm.y, arm.x * arm.z, arm.y * arm.z);
    }
  }
  return own;
}

void remove_turn(const SpringSystem* s, local const SpringState* q) {
  FOR_PARTICLES_OF(s, k) {
    if (!(mobility_of(s, k) > 0)) continue;
    const double3 arm = middle_of(s, k, q->half_dt) - q->center.xyz;
    store_vector(vector_at(s->velocity, k) - cross_product(q->turn, arm), s->velocity, k);
  }
}

void end_part(const SpringSystem* s, double share) {
  FOR_PARTICLES_OF(s, k) {
    const double3 v = vector_at(s->velocity, k);
    store_vector(vector_at(s->position, k) + (s->all.dt * share) * v, s->position, k);
    store_vector(vector_at(s->mean_velocity, k) + share * v, s->mean_velocity, k);
    store_vector(2 * v - vector_at(s->start_velocity, k), s->start_velocity, k);
  }
}

void end_drift(const SpringSystem* s) {
  FOR_PARTICLES_OF(s, k) {
    const int i = s->all.begin + k;
    const double3 way = s->all.dt * vector_at(s->mean_velocity, k);
    store_vector(vector_at(s->start_of_drift, i) + way, s->body_position, i);
    store_vector(vector_at(s->start_velocity, k), s->body_velocity, i);
  }
}

// Of a time step, the implicit Euler steps of the dashpots.
double share_of_dashpots(void) {
  return 0.29289321881345247560;  // 1 - sqrt(1/2)
}

// Sets the slopes of dashpots.
void begin_dashpots(const SpringSystem* s) {
  FOR_PARTICLES_OF(s, k) {
    const int i = s->all.begin + k;
    for (uint e = s->spring_begin[i]; e < s->spring_begin[i + 1]; ++e) {
      const SpringEnd spring = s->springs[e];
      const double3 x = vector_at(s->body_position, i) - vector_at(s->body_position, spring.other);
      const double r = sqrt(product(x, x));
      const double3 n = r > 0 ? x / r
                              : direction_if_coincident(s->all.first + i,
                                                        s->all.first + spring.other,
                                                        s->all.dimensions);
      const SpringSlope slope = {{n.x, n.y, n.z},
                                 share_of_dashpots() * s->all.dt * spring.damping, 0};
      s->slopes[e - s->all.springs_begin] = slope;
    }
  }
}

// residual = the impulses of the dashpots.
void push_dashpots(const SpringSystem* s) {
  FOR_PARTICLES_OF(s, k) {
    const int i = s->all.begin + k;
    double3 r = 0;
    const uint end = s->mobility[i] > 0 ? s->spring_begin[i + 1] : s->spring_begin[i];
    for (uint e = s->spring_begin[i]; e < end; ++e) {
      const SpringSlope slope = s->slopes[e - s->all.springs_begin];
      const double3 n = direction_of_slope(&slope);
      const double3 v =
          vector_at(s->body_velocity, i) - vector_at(s->body_velocity, s->springs[e].other);
      r -= (slope.along * product(v, n)) * n;
    }
    store_vector(r, s->residual, k);
  }
}

void end_dashpots(const SpringSystem* s, double onwards) {
  FOR_PARTICLES_OF(s, k) {
    const int i = s->all.begin + k;
    const double3 v = vector_at(s->body_velocity, i) + onwards * vector_at(s->change, k);
    store_vector(v, s->body_velocity, i);
  }
}

// The work of a phase. Returns its part of a sum.
double4 work_on_springs(const SpringSystem* s, local SpringState* q, int phase) {
  double4 own = 0;
  switch (phase) {
    case kBeginDrift:
      begin_drift(s);
      break;
    case kBeginPart:
      FOR_PARTICLES_OF(s, k) store_vector(vector_at(s->start_velocity, k), s->velocity, k);
      break;
    case kFindResidual:
      own = find_residual(s, q->half_dt);
      break;
    case kCheckResidual:
      own.x = size_of_gained(s);
      break;
    case kFollowChange:
      follow_change(s, q->part_of_step, q->shortening == 0);
      break;
    case kFindMiddle:
      own = weighted_middle(s, q->half_dt);
      break;
    case kFindTurn:
      own = moment_of(s, q);
      break;
    case kRemoveTurn:
      remove_turn(s, q);
      break;
    case kEndPart:
      end_part(s, 1.0 / (1 << q->halvings));
      break;
    case kBeginDamping:
      begin_dashpots(s);
      break;
    case kPushDashpots:
      push_dashpots(s);
      break;
    case kEndDamping:
      end_dashpots(s, q->stage == 0 ? (1 - share_of_dashpots()) / share_of_dashpots() : 1);
      break;
    default:
      own = work_on_system(s, q, phase);
  }
  return own;
}

// The solution of a x = b for a symmetric positive definite matrix with the diagonal entries xx, yy, zz
// and the others xy, xz, yz.
double3 solve_symmetric(double3 diagonal, double3 off, double3 b) {
  const double l10 = off.x / diagonal.x;
  const double l20 = off.y / diagonal.x;
  const double d1 = diagonal.y - l10 * off.x;
  const double u21 = off.z - l10 * off.y;
  const double l21 = u21 / d1;
  const double d2 = diagonal.z - l20 * off.y - l21 * u21;
  const double y1 = b.y - l10 * b.x;
  const double z = (b.z - l20 * b.x - l21 * y1) / d2;
  const double y = y1 / d1 - l21 * z;
  return (double3)(b.x / diagonal.x - l10 * y - l20 * z, y, z);
}

// The rotation that removes the error of the angular momentum, see BodyDrift::remove_turn().
double3 find_turn(local const SpringState* q) {
  const double3 diagonal = q->inertia;
  const double trace = diagonal.x + diagonal.y + diagonal.z;
  // Particles in a line have no torque along it, where their inertia is zero.
  return trace > 0 ? solve_symmetric(diagonal + 1e-12 * trace, q->inertia_products, q->torque)
                   : (double3)(0);
}

// Begins a solve for the present part of the drift.
int begin_part(const SpringSystem* s, local SpringState* q) {
  q->half_dt = s->all.dt / (1 << q->halvings) / 2;
  q->newton_step = -1;
  q->is_exact = 0;
  return kBeginPart;
}

// Ends Newton's method; see BodyDrift::take().
int end_newton(const SpringSystem* s, local SpringState* q, bool is_solved) {
  if (!is_solved && q->width >= 0) {
    // Rounding errors of the factor may prevent a solution that conjugate gradients find.
    q->width = -1;
    q->is_factored = 0;
    return begin_part(s, q);
  }
  if (!is_solved && q->halvings < 6) {
    ++q->halvings;
    q->part *= 2;
    return begin_part(s, q);
  }
  if (!is_solved) q->are_solved = 0;
  q->after_turn = kEndPart;
  q->round = 0;
  // An error above the tolerance is no small rotation; its correction would stretch the springs.
  return q->is_exact && s->body.can_turn ? kFindMiddle : kEndPart;
}

// Chooses the next part of the drift, or the end.
int follow_part(const SpringSystem* s, local SpringState* q) {
  while (q->halvings > 0 && (q->part & 1)) {
    q->part /= 2;
    --q->halvings;
  }
  if (q->halvings == 0) return kEndGroup;
  ++q->part;
  return begin_part(s, q);
}

// Compares the residual with that before a step of Newton's method.
int follow_residual(const SpringSystem* s, local SpringState* q, double4 sum) {
  ++q->passes;
  if (q->newton_step < 0 || sum.x < q->residual) {
    q->residual = sum.x;
    q->rounding = sum.y;
    ++q->newton_step;
    return kCheckResidual;
  }
  ++q->shortening;
  q->part_of_step /= 2;
  return q->shortening <= 6 ? kFollowChange : end_newton(s, q, false);
}

int follow_check(const SpringSystem* s, local SpringState* q, double change2) {
  q->is_exact = q->residual <= 1e-6 * 1e-6 * change2;
  if (q->is_exact || q->residual <= q->rounding) return end_newton(s, q, true);
  if (q->newton_step == 20) return end_newton(s, q, false);
  q->tolerance = 0.1;
  q->after_solve = kFollowChange;
  q->shortening = 0;
  q->part_of_step = 1;
  return kBeginSolve;
}

int follow_turn(const SpringSystem* s, local SpringState* q, double4 sum) {
  if (q->moment == 0) q->torque = sum.xyz;
  if (q->moment == 1) q->inertia = sum.xyz;
  if (q->moment == 2) q->inertia_products = sum.xyz;
  ++q->moment;
  if (q->moment < 3) return kFindTurn;
  q->turn = find_turn(q);
  return kRemoveTurn;
}

int follow_removal(local SpringState* q) {
  const double3 turn = q->turn;
  ++q->round;
  const bool was_turned = q->half_dt * sqrt(product(turn, turn)) > DBL_EPSILON;
  return q->after_turn == kEndPart && was_turned && q->round < 8 ? kFindMiddle : q->after_turn;
}

// Ends a phase with the sum of all work-items. Returns the next phase.
int follow_springs(const SpringSystem* s, local SpringState* q, int phase, double4 sum) {
  switch (phase) {
    case kBeginDrift:
      return begin_part(s, q);
    case kBeginPart:
      return kFindResidual;
    case kFindResidual:
      return follow_residual(s, q, sum);
    case kCheckResidual:
      return follow_check(s, q, sum.x);
    case kFollowChange:
      q->after_turn = kFindResidual;
      return s->body.can_turn ? kFindMiddle : kFindResidual;
    case kFindMiddle:
      q->center.xyz =
          s->body.pivot >= 0 ? vector_at(s->position, s->body.pivot) : sum.xyz / sum.w;
      q->moment = 0;
      return kFindTurn;
    case kFindTurn:
      return follow_turn(s, q, sum);
    case kRemoveTurn:
      return follow_removal(q);
    case kEndPart:
      return follow_part(s, q);
    case kBeginDamping:
      q->stage = 0;
      return kPushDashpots;
    case kPushDashpots:
      ++q->passes;
      q->tolerance = 1e-4;
      q->after_solve = kEndDamping;
      return kBeginSolve;
    case kEndDamping:
      ++q->stage;
      return q->stage < 2 ? kPushDashpots : kEndGroup;
    default:
      return follow_system(s, q, phase, sum);
  }
}

SpringSystem system_of(Implicit all, ImplicitBody body, global const uint* spring_begin,
                       global const SpringEnd* springs, global const double* mass,
                       global const double* mobility, global const double* stiffness,
                       global const uint* places, global SpringSlope* slopes,
                       global double* factor, global double* columns,
                       global const double* start, global double* position,
                       global double* velocity) {
  const long size = 3 * (long)all.count;
  const SpringSystem s = {all,
                          body,
                          spring_begin,
                          springs,
                          mass,
                          mobility,
                          stiffness,
                          places,
                          slopes,
                          factor,
                          columns,
                          columns + size,
                          columns + 2 * size,
                          columns + 3 * size,
                          columns + 4 * size,
                          columns + 5 * size,
                          columns + 6 * size,
                          columns + 7 * size,
                          columns + 8 * size,
                          columns + 9 * size,
                          columns + 10 * size,
                          columns + 11 * size,
                          start,
                          position,
                          velocity};
  return s;
}

// The first width of the tree of a sum over the particles of a body.
int widest_sum(int count) {
  int width = GROUP / 2;
  while (width > 0 && width >= count) width /= 2;
  return width;
}

// Moves each body from the positions `start` over the drift of `dt`, or applies its dashpots over `dt`.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void move_implicit_springs(
    const Implicit all, const int is_damping, global const ImplicitBody* bodies,
    global const uint* spring_begin, global const SpringEnd* springs, global const double* mass,
    global const double* mobility, global const double* stiffness, global const uint* places,
    global SpringSlope* slopes, global double* factor, global double* columns,
    global const double* start, global double* position, global double* velocity,
    global ImplicitCounts* counts) {
  local double4 sums[GROUP];
  local SpringState state;
  const ImplicitBody body = bodies[get_group_id(0)];
  const SpringSystem s =
      system_of(all, body, spring_begin, springs, mass, mobility, stiffness, places, slopes,
                factor, columns, start, position, velocity);
  const int t = get_local_id(0);
  const int widest = widest_sum(body.end - body.begin);
  int phase = !is_damping ? kBeginDrift : body.is_damped ? kBeginDamping : kEndGroup;
  if (t == 0) {
    state.width = body.width;
    state.is_factored = 0;
    state.iterations = 0;
    state.halvings = 0;
    state.part = 0;
    state.are_solved = 1;
    state.passes = 0;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  while (phase != kEndGroup) {
    sums[t] = work_on_springs(&s, &state, phase);
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (int width = widest; width > 0; width /= 2) {
      if (t < width) sums[t] += sums[t + width];
      barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (t == 0) state.phase = follow_springs(&s, &state, phase, sums[0]);
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    phase = state.phase;
  }
  if (!is_damping) end_drift(&s);
  if (t != 0) return;
  counts[get_group_id(0)].passes += state.passes;
  counts[get_group_id(0)].unsolved += state.are_solved ? 0 : 1;
}
