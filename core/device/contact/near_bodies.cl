// Rigid bodies whose particles may touch those of others. The other particles need no search for
// contacts.

// Each column of spheres may be followed by a vector.
#define SPHERES_END 8
#define MOST_NEAR_BODIES 24

// The spheres around rigid bodies are three columns of their centres and one of their radii. Body
// near[k * count + b] may touch body b, for k < counts[b]. If counts[b] exceeds MOST_NEAR_BODIES, the
// list is not complete.
typedef struct {
  int is_used;
  int count;
  double reach;
} NearSearch;

typedef struct {
  global const double* spheres;
  global const int* counts;
  global const int* near;
} NearBodies;

#define ABOVE_ROUNDING (1 + 1e-9)

kernel void place_spheres(const NearSearch search, global const Rigid* rigid,
                          global const Pose* poses, global double* spheres) {
  const int b = get_global_id(0);
  if (b >= search.count) return;
  const int stride = search.count + SPHERES_END;
  for (int k = 0; k < 3; ++k) spheres[k * stride + b] = poses[b].center[k];
  spheres[3 * stride + b] = rigid[b].extent;
}

kernel void find_near_bodies(const NearSearch search, global const double* spheres,
                             global int* counts, global int* near) {
  const int b = get_global_id(0);
  if (b >= search.count) return;
  const int stride = search.count + SPHERES_END;
  const double3 center = (double3)(spheres[b], spheres[stride + b], spheres[2 * stride + b]);
  const double reach = spheres[3 * stride + b] + search.reach;
  int count = 0;
#if LANES > 1
  for (int block = 0; block < search.count; block += 8) {
    global const double* others = spheres + block;
    const double8 x = vload8(0, others) - center.x;
    const double8 y = vload8(0, others + stride) - center.y;
    const double8 z = vload8(0, others + 2 * stride) - center.z;
    const double8 sum = vload8(0, others + 3 * stride) + reach;
    const int8 is_inside = (int8)(0, 1, 2, 3, 4, 5, 6, 7) < search.count - block;
    uint bits = byte_of(convert_char8(x * x + y * y + z * z < sum * sum * ABOVE_ROUNDING) &
                        convert_char8(is_inside));
    while (bits != 0) {
      const int other = block + 31 - clz(bits & -bits);
      bits &= bits - 1;
      if (other == b) continue;
      if (count < MOST_NEAR_BODIES) near[count * search.count + b] = other;
      ++count;
    }
  }
#else
  for (int other = 0; other < search.count; ++other) {
    const double3 way = (double3)(spheres[other], spheres[stride + other],
                                  spheres[2 * stride + other]) - center;
    const double sum = spheres[3 * stride + other] + reach;
    if (other == b || !(product(way, way) < sum * sum * ABOVE_ROUNDING)) continue;
    if (count < MOST_NEAR_BODIES) near[count * search.count + b] = other;
    ++count;
  }
#endif
  counts[b] = count;
}

// Whether a particle of the rigid body b at the place x may touch one of another body.
INLINE bool may_touch(const NearSearch* search, const NearBodies* bodies, int b, double3 x) {
  const int count = bodies->counts[b];
  if (count > MOST_NEAR_BODIES) return true;
  const int stride = search->count + SPHERES_END;
  for (int k = 0; k < count; ++k) {
    const int other = bodies->near[k * search->count + b];
    const double3 way = x - (double3)(bodies->spheres[other], bodies->spheres[stride + other],
                                      bodies->spheres[2 * stride + other]);
    const double reach = bodies->spheres[3 * stride + other] + search->reach;
    if (product(way, way) < reach * reach * ABOVE_ROUNDING) return true;
  }
  return false;
}
