// Reductions for adaptive steps: greatest speeds, pressures of a given rank, and changes of motion
// in a probe. See core/stepping/control/step_control.h. All arrays are in the order of particles.

typedef struct {
  double mean[3];
  uint prefix;
  int rank;
} Motion;

// Sums the velocities. The maximum is that of their squares.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void sum_velocities(
    const int count, global const double* velocity, global double4* partial) {
  local double4 sums[GROUP];
  const int i = get_global_id(0);
  double4 own = 0;
  if (i < count) {
    own = (double4)(velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2], 0);
    own.w = own.x * own.x + own.y * own.y + own.z * own.z;
  }
  write_partial(sums, own, partial);
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_mean(
    const int count, const int groups, const int result, global const double4* partial,
    global Motion* motion, global double4* results) {
  local double4 sums[GROUP];
  const double4 total = sum_partial(sums, groups, partial);
  if (get_local_id(0) != 0) return;
  motion->mean[0] = total.x / (double)count;
  motion->mean[1] = total.y / (double)count;
  motion->mean[2] = total.z / (double)count;
  results[result].x = total.w;
}

double4 greatest_of(double4 a, double4 b) {
  return (double4)(greater(a.x, b.x), greater(a.y, b.y), greater(a.z, b.z), greater(a.w, b.w));
}

// The maxima of the components over the group.
double4 maximum_of_group(local double4* maxima, double4 own) {
  maxima[get_local_id(0)] = own;
  COMBINE_GROUP(maxima, greatest_of)
  return maxima[0];
}

// The greatest motion of a body: squares of the velocity relative to the mean and of the
// acceleration, and 2 way / travel_time(way). `four_ways` is 4 way.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_greatest_motion(
    const int first, const int count, const double four_ways, global const double* velocity,
    global const float4* acceleration, global const Motion* motion, global double4* partial) {
  local double4 maxima[GROUP];
  double4 own = 0;
  if ((int)get_global_id(0) < count) {
    const int i = first + get_global_id(0);
    const float4 a4 = acceleration[i];
    const double a[3] = {a4.x, a4.y, a4.z};
    double speed2 = 0;
    for (int k = 0; k < 3; ++k) {
      const double v = velocity[3 * i + k];
      const double relative = v - motion->mean[k];
      speed2 += v * v;
      own.x += relative * relative;
      own.y += a[k] * a[k];
    }
    own.z = sqrt(speed2) + sqrt(speed2 + four_ways * sqrt(own.y));
  }
  const double4 greatest = maximum_of_group(maxima, own);
  if (get_local_id(0) == 0) partial[get_group_id(0)] = greatest;
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void end_greatest_motion(
    const int groups, const int result, global const double4* partial, global double4* results) {
  local double4 maxima[GROUP];
  double4 own = 0;
  for (int n = get_local_id(0); n < groups; n += GROUP) own = greatest_of(own, partial[n]);
  const double4 greatest = maximum_of_group(maxima, own);
  if (get_local_id(0) == 0) results[result] = greatest;
}

// Squares of the velocities of a body relative to the mean.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_relative_speeds(
    const int first, const int count, global const double* velocity, global const Motion* motion,
    global double4* partial) {
  local double4 sums[GROUP];
  double4 own = 0;
  if ((int)get_global_id(0) < count) {
    const int i = first + get_global_id(0);
    for (int k = 0; k < 3; ++k) {
      const double v = velocity[3 * i + k] - motion->mean[k];
      own.w += v * v;
    }
  }
  write_partial(sums, own, partial);
}

// Stores the greatest speed of a body, and begins the selection of the pressure of a rank.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void begin_selection(
    const int groups, const int rank, const int result, global const double4* partial,
    global Motion* motion, global double4* results, global int* histogram) {
  local double4 sums[GROUP];
  const double4 total = sum_partial(sums, groups, partial);
  histogram[get_local_id(0)] = 0;
  if (get_local_id(0) != 0) return;
  results[result].x = total.w;
  motion->prefix = 0;
  motion->rank = rank;
}

// A key in the order of pressures, which are not negative.
uint key_of(double pressure) {
  return as_uint((float)pressure);
}

#define DIGITS 256

// Counts the values of the digit at `shift` of the keys that have the prefix in their higher digits.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void count_digits(
    const int first, const int count, const int shift, global const double* pressure,
    global const Motion* motion, global int* histogram) {
  local int bins[DIGITS];
  const int t = get_local_id(0);
  bins[t] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  if ((int)get_global_id(0) < count) {
    const uint key = key_of(pressure[first + get_global_id(0)]);
    const ulong higher = ~0ul << (shift + 8);
    if ((key & higher) == motion->prefix) atomic_inc(bins + ((key >> shift) & (DIGITS - 1)));
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (bins[t] != 0) atomic_add(histogram + t, bins[t]);
}

// Selects the digit at `shift` of the key with the rank. The last digit completes the key.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void select_digit(
    const int shift, const int result, global int* histogram, global Motion* motion,
    global double4* results) {
  const int t = get_local_id(0);
  if (t == 0) {
    int rank = motion->rank;
    uint digit = 0;
    while (digit < DIGITS - 1 && rank >= histogram[digit]) rank -= histogram[digit++];
    motion->rank = rank;
    motion->prefix |= digit << shift;
    if (shift == 0) results[result].y = as_float(motion->prefix);
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  histogram[t] = 0;
}

// Sums the changes of position, or of acceleration if `is_force` is set, of a body, weighted by
// mass. With `is_square`, sums the squares relative to the mean.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void sum_changes(
    const int first, const int count, const int is_force, const int is_square,
    global const double* position_before, global const double* position,
    global const float4* acceleration_before, global const float4* acceleration,
    global const float* weight, global const Motion* motion, global double4* partial) {
  local double4 sums[GROUP];
  double4 own = 0;
  if ((int)get_global_id(0) < count) {
    const int i = first + get_global_id(0);
    const float4 a = acceleration[i] - acceleration_before[i];
    const float by[3] = {a.x, a.y, a.z};
    const double w = weight[i];
    double change[3];
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const double moved = position[3 * i + k] - position_before[3 * i + k];
      change[k] = is_force ? (double)by[k] : moved;
      const double relative = change[k] - motion->mean[k];
      square += relative * relative;
    }
    if (is_square) {
      own.x = w * square;
    } else {
      own = (double4)(w * change[0], w * change[1], w * change[2], 0);
    }
  }
  write_partial(sums, own, partial);
}

// Ends the sums of sum_changes. `scale` is 1 / the sum of the weights.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void end_changes(
    const int groups, const double scale, const int is_force, const int is_square,
    const int result, global const double4* partial, global Motion* motion,
    global double4* results) {
  local double4 sums[GROUP];
  const double4 total = sum_partial(sums, groups, partial);
  if (get_local_id(0) != 0) return;
  if (!is_square) {
    motion->mean[0] = total.x * scale;
    motion->mean[1] = total.y * scale;
    motion->mean[2] = total.z * scale;
  } else if (is_force) {
    results[result].y = total.x * scale;
  } else {
    results[result].x = total.x * scale;
  }
}
