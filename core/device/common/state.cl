// The check of states, and sums over all particles.

#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#ifdef VAT_EXACT
#pragma OPENCL FP_CONTRACT OFF
#endif

#define INLINE static inline __attribute__((always_inline))

// Particles of a group.
#define GROUP 256

// Work-items of some kernels compute LANES particles at once, in vectors. Each particle has the same
// operations in the same order as without vectors, so that the bits do not depend on LANES.
#ifndef LANES
#define LANES 1
#endif
#define ITEMS (GROUP / LANES)

// Counters, see Counters.
enum { kFault = 0, kStops = 1 };

// Whether a position is in the domain, and the velocity is not too great. In this form, a NaN
// fails.
bool is_within(const double* low, const double* high, double greatest_speed2, const double* x,
               const double* v) {
  bool sound = v[0] * v[0] + v[1] * v[1] + v[2] * v[2] <= greatest_speed2;
  for (int k = 0; k < 3; ++k) sound = sound && x[k] >= low[k] && x[k] <= high[k];
  return sound;
}

// The image of a coordinate in a periodic box, see PeriodicBox::wrap(). An axis with the length 0 is not
// periodic.
double wrapped(double x, double low, double length) {
  const double high = low + length;
  if (length == 0 || (x >= low && x < high)) return x;
  const double image = x - length * floor((x - low) / length);
  // Rounding may move the image out of the box. In this form, a NaN remains.
  return image < low || image >= high ? low : image;
}

typedef struct {
  double low[3];
  double length[3];
} PeriodicBox;

// Moves particles that have left a periodic world to the opposite side.
kernel void wrap_particles(const int count, const PeriodicBox box, global double* position) {
  const int i = get_global_id(0);
  if (i >= count) return;
  for (int k = 0; k < 3; ++k) {
    position[3 * i + k] = wrapped(position[3 * i + k], box.low[k], box.length[k]);
  }
}

// Each sum is a fixed tree: first over a group, then over the partial sums of the groups.

// The maximum, and `a` if the comparison fails because of a NaN.
double greater(double a, double b) {
  return a < b ? b : a;
}

double4 combined(double4 a, double4 b) {
  return (double4)(a.x + b.x, a.y + b.y, a.z + b.z, greater(a.w, b.w));
}

// The least power of two that is not less than `count`, at most GROUP.
int leaves_of_tree(int count) {
  return count <= 1 ? 1 : 2 << (31 - clz(min(count, GROUP) - 1));
}

// Combines `count` values of a group by `combine` in a tree, into values[0]. The values from `count`
// to leaves_of_tree(count) are 0. On a CPU, one work-item does so, because a barrier takes more time
// than some combinations.
#if LANES > 1
#define COMBINE_SOME(values, count, combine)                                   \
  {                                                                            \
    barrier(CLK_LOCAL_MEM_FENCE);                                              \
    if (get_local_id(0) == 0) {                                                \
      for (int width = leaves_of_tree(count) / 2; width > 0; width /= 2) {     \
        for (int t = 0; t < width; ++t) {                                      \
          values[t] = combine(values[t], values[t + width]);                   \
        }                                                                      \
      }                                                                        \
    }                                                                          \
    barrier(CLK_LOCAL_MEM_FENCE);                                              \
  }
#else
#define COMBINE_SOME(values, count, combine)                                   \
  {                                                                            \
    const int t = get_local_id(0);                                             \
    barrier(CLK_LOCAL_MEM_FENCE);                                              \
    for (int width = leaves_of_tree(count) / 2; width > 0; width /= 2) {       \
      if (t < width) values[t] = combine(values[t], values[t + width]);        \
      barrier(CLK_LOCAL_MEM_FENCE);                                            \
    }                                                                          \
  }
#endif
#define COMBINE_GROUP(values, combine) COMBINE_SOME(values, GROUP, combine)

// The sums of the first three components over the group, and the maximum of the fourth one.
double4 sum_group(local double4* sums, double4 own) {
  sums[get_local_id(0)] = own;
  COMBINE_GROUP(sums, combined)
  return sums[0];
}

void write_partial(local double4* sums, double4 own, global double4* partial) {
  const double4 total = sum_group(sums, own);
  if (get_local_id(0) == 0) partial[get_group_id(0)] = total;
}

// The result of sum_group() for the values of a group that are in `sums`.
double4 sum_lanes(local double4* sums) {
  COMBINE_GROUP(sums, combined)
  return sums[0];
}

void write_partial_of_lanes(local double4* sums, global double4* partial) {
  const double4 total = sum_lanes(sums);
  if (get_local_id(0) == 0) partial[get_group_id(0)] = total;
}

// The total of the partial sums, for one group.
double4 sum_partial(local double4* sums, int count, global const double4* partial) {
  double4 own = 0;
  for (int n = get_local_id(0); n < count; n += GROUP) own = combined(own, partial[n]);
  return sum_group(sums, own);
}

#if LANES > 1
// The lowest bits of eight numbers that are 0 or -1.
INLINE uint byte_of(char8 bits) {
  return ((as_ulong(bits) & 0x0101010101010101UL) * 0x0102040810204080UL) >> 56;
}
#endif
