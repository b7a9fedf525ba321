// Linear equations of implicit springs, see core/solid/spring_system.h. One group of work-items moves one
// body. It runs in phases: all work-items do the work of a phase, their sums are added by a fixed tree,
// and then the first work-item chooses the next phase. No barrier is in a branch, because PoCL copies
// the code after such barriers. Particles are counted from the first one with implicit springs.

// The derivative of a spring's impulse on one of its ends with respect to the velocities, see
// SpringSlope.
typedef struct {
  double direction[3];
  double along;
  double across;
} SpringSlope;

// A body with implicit springs.
typedef struct {
  long factor_begin;  // of its Cholesky factor, in numbers
  double free_mass;   // 0 if a particle is fixed
  int begin;
  int end;
  int width;  // of the Cholesky factor in blocks; -1 without a factor
  int factor_cost;
  int can_turn;
  int pivot;  // the only fixed particle; -1 without
  int is_damped;
  int padding;
} ImplicitBody;

// The number of passes over the springs of a body, and of drifts without a solution.
typedef struct {
  ulong passes;
  ulong unsolved;
} ImplicitCounts;

// Constants of all bodies with implicit springs. `begin` is the first of their particles among the
// solids, and `springs_begin` the first of their spring ends.
typedef struct {
  int begin;
  int count;
  int springs_begin;
  int first;
  int dimensions;
  int padding;
  double dt;
} Implicit;

// The phases of a group. Those of a linear solve come first.
typedef enum {
  kBeginSolve,
  kClearBand,
  kFillBand,
  kFactorPanel,
  kUpdateBand,
  kBeginIterations,
  kOrder,
  kForward,
  kBackward,
  kFindMomentum,
  kEndPrecondition,
  kTurnDirection,
  kMultiply,
  kAdvance,
  kBeginDrift,
  kBeginPart,
  kFindResidual,
  kCheckResidual,
  kFollowChange,
  kFindMiddle,
  kFindTurn,
  kRemoveTurn,
  kEndPart,
  kBeginDamping,
  kPushDashpots,
  kEndDamping,
  kEndGroup
} SpringPhase;

// The state of a group.
typedef struct {
  double4 center;   // and the mass
  double3 torque;
  double3 inertia;
  double3 inertia_products;
  double3 turn;
  double3 missing;  // momentum of the solution by the factor, or the velocity that adds it
  double size;      // of the remaining residual of the linear equations
  double enough;
  double next;
  double last;
  double length;  // of a step of conjugate gradients
  double tolerance;
  double residual;
  double rounding;
  double half_dt;       // half of the present part of the drift
  double part_of_step;  // of Newton's method
  int phase;
  int width;
  int is_factored;
  int is_sound;
  int iterations;  // without a factor
  int iteration;
  int limit;
  int attempt;
  int first;  // row of the factor
  int sums;   // 1: the phase adds numbers
  int after_solve;
  int after_turn;
  int moment;
  int newton_step;
  int shortening;
  int halvings;
  int part;  // index among the parts of this length
  int round;
  int is_exact;
  int stage;
  int are_solved;
  ulong passes;
} SpringState;

// The equations of one body. Columns have three numbers for each particle.
typedef struct {
  Implicit all;
  ImplicitBody body;
  global const uint* spring_begin;
  global const SpringEnd* springs;
  global const double* mass;
  global const double* mobility;
  global const double* stiffness;  // sums of the springs of each particle
  global const uint* places;
  global SpringSlope* slopes;
  global double* factor;
  global double* residual;
  global double* change;
  global double* remaining;
  global double* preconditioned;
  global double* direction;
  global double* product;
  global double* ordered;
  global double* position;
  global double* start_velocity;
  global double* mean_velocity;
  global double* velocity;
  global double* last_velocity;
  global const double* start_of_drift;  // positions of all particles
  global double* body_position;
  global double* body_velocity;
} SpringSystem;

#define FOR_PARTICLES_OF(s, k)                                              \
  for (int k = (s)->body.begin + (int)get_local_id(0); k < (s)->body.end;   \
       k += GROUP)

double mass_of(const SpringSystem* s, int k) {
  return s->mass[s->all.begin + k];
}
double mobility_of(const SpringSystem* s, int k) {
  return s->mobility[s->all.begin + k];
}

double3 direction_of_slope(const SpringSlope* slope) {
  return (double3)(slope->direction[0], slope->direction[1], slope->direction[2]);
}

// product = (M + slopes) direction. Returns the part of <direction, product>.
double multiply_springs(const SpringSystem* s) {
  double own = 0;
  FOR_PARTICLES_OF(s, k) {
    const int i = s->all.begin + k;
    double3 sum = 0;
    const double3 mine = vector_at(s->direction, k);
    if (s->mobility[i] > 0) {
      sum = s->mass[i] * mine;
      for (uint e = s->spring_begin[i]; e < s->spring_begin[i + 1]; ++e) {
        const SpringSlope slope = s->slopes[e - s->all.springs_begin];
        const int other = (int)s->springs[e].other - s->all.begin;
        const double3 d = mine - vector_at(s->direction, other);
        const double3 n = direction_of_slope(&slope);
        sum += slope.across * d + ((slope.along - slope.across) * product(n, d)) * n;
      }
    }
    store_vector(sum, s->product, k);
    own += product(mine, sum);
  }
  return own;
}

// change = 0, remaining = residual. Returns the part of the size of `remaining`.
double begin_solve(const SpringSystem* s) {
  double own = 0;
  FOR_PARTICLES_OF(s, k) {
    const double3 r = vector_at(s->residual, k);
    store_vector((double3)(0), s->change, k);
    store_vector(r, s->remaining, k);
    own += mobility_of(s, k) * product(r, r);
  }
  return own;
}

void turn_direction(const SpringSystem* s, local const SpringState* q) {
  const double kept = q->next / q->last;
  FOR_PARTICLES_OF(s, k) {
    const double3 z = q->is_factored ? vector_at(s->preconditioned, k)
                                     : mobility_of(s, k) * vector_at(s->remaining, k);
    store_vector(z + kept * vector_at(s->direction, k), s->direction, k);
  }
}

// Advances along the direction. Returns the part of the size of `remaining`.
double advance_solve(const SpringSystem* s, double length) {
  double own = 0;
  FOR_PARTICLES_OF(s, k) {
    const double3 w = vector_at(s->change, k) + length * vector_at(s->direction, k);
    const double3 r = vector_at(s->remaining, k) - length * vector_at(s->product, k);
    store_vector(w, s->change, k);
    store_vector(r, s->remaining, k);
    own += mobility_of(s, k) * product(r, r);
  }
  return own;
}

// The Cholesky factor has the columns of its lower triangle, each from the diagonal down; see
// BandFactor.

int height_of_band(const SpringSystem* s) {
  return 3 * (s->body.width + 1);
}
int rows_of_band(const SpringSystem* s) {
  return 3 * (s->body.end - s->body.begin);
}

// The entries of column `j` from the diagonal down.
global double* band_column(const SpringSystem* s, int j) {
  return s->factor + s->body.factor_begin + (long)j * height_of_band(s);
}

// Adds a block with the entries of scale I + more n n^T at a block row and column of the lower triangle.
void add_to_band(const SpringSystem* s, int row, int column, double scale, double more,
                 const double* n) {
  const int low = min(row, column);
  const int high = max(row, column);
  for (int c = 0; c < 3; ++c) {
    global double* own = band_column(s, 3 * low + c);
    for (int r = row == column ? c : 0; r < 3; ++r) {
      own[3 * high + r - 3 * low - c] += (r == c ? scale : 0) + more * n[r] * n[c];
    }
  }
}

void clear_band(const SpringSystem* s) {
  const int height = height_of_band(s);
  for (int c = get_local_id(0); c < rows_of_band(s); c += GROUP) {
    global double* own = band_column(s, c);
    for (int r = 0; r < height; ++r) own[r] = 0;
  }
}

// Sets the entries of M + slopes. The row of a fixed particle is that of the unit matrix.
void fill_band(const SpringSystem* s) {
  const double none[3] = {0, 0, 0};
  FOR_PARTICLES_OF(s, k) {
    const int i = s->all.begin + k;
    const int place = s->places[k];
    const bool is_free = s->mobility[i] > 0;
    add_to_band(s, place, place, is_free ? s->mass[i] : 1, 0, none);
    const uint end = is_free ? s->spring_begin[i + 1] : s->spring_begin[i];
    for (uint e = s->spring_begin[i]; e < end; ++e) {
      const SpringSlope slope = s->slopes[e - s->all.springs_begin];
      const double more = slope.along - slope.across;
      add_to_band(s, place, place, slope.across, more, slope.direction);
      const int other = s->springs[e].other;
      if (other < i && s->mobility[other] > 0) {
        add_to_band(s, place, s->places[other - s->all.begin], -slope.across, -more,
                    slope.direction);
      }
    }
  }
}

// The factor of a block on the diagonal, and the inverse values of its diagonal.
typedef struct {
  double l10, l20, l21;
  double scale0, scale1, scale2;
  double pivot0, pivot1, pivot2;
} BlockFactor;

BlockFactor factor_block(global const double* a, global const double* b, global const double* c) {
  BlockFactor f;
  f.pivot0 = a[0];
  f.scale0 = 1 / sqrt(f.pivot0);
  f.l10 = a[1] * f.scale0;
  f.l20 = a[2] * f.scale0;
  f.pivot1 = b[0] - f.l10 * f.l10;
  f.scale1 = 1 / sqrt(f.pivot1);
  f.l21 = (b[1] - f.l10 * f.l20) * f.scale1;
  f.pivot2 = c[0] - f.l20 * f.l20 - f.l21 * f.l21;
  f.scale2 = 1 / sqrt(f.pivot2);
  return f;
}

// Computes the rows of a block column below its diagonal.
void factor_panel(const SpringSystem* s, int first) {
  global double* a = band_column(s, first);
  global double* b = band_column(s, first + 1);
  global double* c = band_column(s, first + 2);
  const int t = get_local_id(0);
  if (t < 3 || t >= min(height_of_band(s), rows_of_band(s) - first)) return;
  const BlockFactor f = factor_block(a, b, c);
  a[t] *= f.scale0;
  b[t - 1] = (b[t - 1] - f.l10 * a[t]) * f.scale1;
  c[t - 2] = (c[t - 2] - f.l20 * a[t] - f.l21 * b[t - 1]) * f.scale2;
}

// Subtracts the parts of a block column from later columns, and computes its diagonal. The first
// work-item returns whether its pivots are positive.
bool update_band(const SpringSystem* s, int first) {
  global double* a = band_column(s, first);
  global double* b = band_column(s, first + 1);
  global double* c = band_column(s, first + 2);
  const int t = get_local_id(0);
  const int later = min(height_of_band(s), rows_of_band(s) - first) - 3;
  for (int n = t; n < later * later; n += GROUP) {
    const int u = n / later;
    const int v = n - u * later;
    if (v < u) continue;
    global double* own = band_column(s, first + 3 + u);
    own[v - u] -= a[3 + u] * a[3 + v] + b[2 + u] * b[2 + v] + c[1 + u] * c[1 + v];
  }
  if (t != 0) return true;
  const BlockFactor f = factor_block(a, b, c);
  a[0] = f.pivot0 * f.scale0;
  a[1] = f.l10;
  a[2] = f.l20;
  b[0] = f.pivot1 * f.scale1;
  b[1] = f.l21;
  c[0] = f.pivot2 * f.scale2;
  return f.pivot0 > 0 && f.pivot1 > 0 && f.pivot2 > 0;
}

// Sets `ordered` = remaining in the order of the factor. Returns the part of its sum.
double3 order_remaining(const SpringSystem* s) {
  double3 momentum = 0;
  FOR_PARTICLES_OF(s, k) {
    const double3 r = vector_at(s->remaining, k);
    store_vector(r, s->ordered, s->body.begin + (int)s->places[k]);
    momentum += r;
  }
  return momentum;
}

// Substitutes a block row: `preconditioned` receives the solution for the factor.
void substitute_forward(const SpringSystem* s, int first) {
  global const double* a = band_column(s, first);
  global const double* b = band_column(s, first + 1);
  global const double* c = band_column(s, first + 2);
  global double* x = s->ordered + 3 * s->body.begin;
  global double* y = s->preconditioned + 3 * s->body.begin;
  const int t = get_local_id(0);
  if (t >= min(height_of_band(s), rows_of_band(s) - first)) return;
  const double y0 = x[first] / a[0];
  const double y1 = (x[first + 1] - a[1] * y0) / b[0];
  const double y2 = (x[first + 2] - a[2] * y0 - b[1] * y1) / c[0];
  if (t >= 3) x[first + t] -= a[t] * y0 + b[t - 1] * y1 + c[t - 2] * y2;
  if (t == 0) {
    y[first] = y0;
    y[first + 1] = y1;
    y[first + 2] = y2;
  }
}

// Substitutes a block row: `ordered` receives the solution for the transposed factor.
void substitute_backward(const SpringSystem* s, int first) {
  global const double* a = band_column(s, first);
  global const double* b = band_column(s, first + 1);
  global const double* c = band_column(s, first + 2);
  global double* x = s->ordered + 3 * s->body.begin;
  global double* y = s->preconditioned + 3 * s->body.begin;
  const int t = get_local_id(0);
  const int height = height_of_band(s);
  if (t >= height - 2) return;
  const double x2 = y[first + 2] / c[0];
  const double x1 = (y[first + 1] - b[1] * x2) / b[0];
  const double x0 = (y[first] - a[1] * x1 - a[2] * x2) / a[0];
  const int j = first - t;
  if (t == 0) {
    x[first] = x0;
    x[first + 1] = x1;
    x[first + 2] = x2;
  } else if (j >= 0) {
    // All columns of a block end at the same row.
    global const double* own = band_column(s, j);
    if (first < j - j % 3 + height) {
      y[j] -= own[t] * x0 + own[t + 1] * x1 + own[t + 2] * x2;
    }
  }
}

// The part of the momentum of the solution in `ordered`.
double3 momentum_of_ordered(const SpringSystem* s) {
  double3 momentum = 0;
  FOR_PARTICLES_OF(s, k) {
    momentum += mass_of(s, k) * vector_at(s->ordered, s->body.begin + (int)s->places[k]);
  }
  return momentum;
}

// preconditioned = the solution with the momentum of `remaining`. Returns the part of
// <remaining, preconditioned>.
double end_precondition(const SpringSystem* s, double3 missing) {
  double own = 0;
  FOR_PARTICLES_OF(s, k) {
    const double3 z = vector_at(s->ordered, s->body.begin + (int)s->places[k]) + missing;
    store_vector(z, s->preconditioned, k);
    own += product(vector_at(s->remaining, k), z);
  }
  return own;
}

// The work of a phase of a linear solve. Returns its part of a sum.
double4 work_on_system(const SpringSystem* s, local SpringState* q, int phase) {
  double4 own = 0;
  switch (phase) {
    case kBeginSolve:
      own.x = begin_solve(s);
      break;
    case kClearBand:
      clear_band(s);
      break;
    case kFillBand:
      fill_band(s);
      break;
    case kFactorPanel:
      factor_panel(s, q->first);
      break;
    case kUpdateBand:
      own.x = update_band(s, q->first) ? 0 : 1;
      break;
    case kBeginIterations:
      FOR_PARTICLES_OF(s, k) store_vector((double3)(0), s->direction, k);
      break;
    case kOrder:
      own.xyz = order_remaining(s);
      break;
    case kForward:
      substitute_forward(s, q->first);
      break;
    case kBackward:
      substitute_backward(s, q->first);
      break;
    case kFindMomentum:
      own.xyz = momentum_of_ordered(s);
      break;
    case kEndPrecondition:
      own.x = end_precondition(s, q->missing);
      break;
    case kTurnDirection:
      turn_direction(s, q);
      break;
    case kMultiply:
      own.x = multiply_springs(s);
      break;
    default:
      own.x = advance_solve(s, q->length);
  }
  return own;
}

// Begins an attempt of a solve, see SpringSystem::solve().
int begin_attempt(const SpringSystem* s, local SpringState* q) {
  if (q->attempt == 0) {
    // The factor of earlier slopes remains useful if these are similar.
    q->limit = q->is_factored ? s->body.factor_cost / 2 + 1 : s->body.factor_cost - q->iterations;
    return kBeginIterations;
  }
  q->limit = 1000;
  return q->width >= 0 ? kClearBand : kBeginIterations;
}

// The first phase of an iteration, or of the next attempt if the iterations have ended.
int begin_iteration(const SpringSystem* s, local SpringState* q) {
  if (q->iteration < q->limit) {
    if (q->is_factored) return kOrder;
    q->next = q->size;
    return kTurnDirection;
  }
  if (q->attempt > 0) return q->after_solve;
  q->attempt = 1;
  return begin_attempt(s, q);
}

// Ends a phase of a linear solve with the sum of all work-items. Returns the next phase.
int follow_system(const SpringSystem* s, local SpringState* q, int phase, double4 sum) {
  const int rows = rows_of_band(s);
  switch (phase) {
    case kBeginSolve:
      q->size = sum.x;
      q->enough = q->tolerance * q->tolerance * q->size;
      q->attempt = q->width < 0 ? 1 : 0;
      return q->size == 0 ? q->after_solve : begin_attempt(s, q);
    case kClearBand:
      return kFillBand;
    case kFillBand:
      q->first = 0;
      return kFactorPanel;
    case kFactorPanel:
      return kUpdateBand;
    case kUpdateBand:
      q->is_factored = sum.x == 0;
      q->first += 3;
      return q->is_factored && q->first < rows ? kFactorPanel : kBeginIterations;
    case kBeginIterations:
      q->last = INFINITY;
      q->iteration = 0;
      return begin_iteration(s, q);
    case kOrder:
      q->missing = sum.xyz;
      q->first = 0;
      return kForward;
    case kForward:
      q->first += 3;
      if (q->first < rows) return kForward;
      q->first = rows - 3;
      return kBackward;
    case kBackward:
      q->first -= 3;
      return q->first >= 0 ? kBackward : kFindMomentum;
    case kFindMomentum:
      q->missing = s->body.free_mass == 0 ? (double3)(0)
                                          : (q->missing - sum.xyz) / s->body.free_mass;
      return kEndPrecondition;
    case kEndPrecondition:
      q->next = sum.x;
      return kTurnDirection;
    case kTurnDirection:
      q->last = q->next;
      return kMultiply;
    case kMultiply:
      ++q->passes;
      if (!q->is_factored) ++q->iterations;
      // A curvature that is not positive is too small for the precision of numbers.
      q->length = sum.x > 0 ? q->next / sum.x : 0;
      return sum.x > 0 ? kAdvance : q->after_solve;
    default:
      q->size = sum.x;
      ++q->iteration;
      return q->size <= q->enough ? q->after_solve : begin_iteration(s, q);
  }
}
