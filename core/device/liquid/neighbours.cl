// Neighbours of particles, and their lists. A wall is a mirror, and the sides of a periodic axis shift
// by its period. The images near a particle are the particles near its own images.

// The kernel of the scene, see core/kernels/smoothing_kernel.h, for numbers and vectors.
#ifdef VAT_CUBIC_SPLINE
#define DEFINE_KERNEL(Reals, kernel_value, kernel_slope)                       \
  Reals kernel_value(Reals q) {                                                \
    const Reals rest = 1 - q;                                                  \
    return q < 0.5f ? 1 - 6 * q * q * rest : 2 * (rest * rest) * rest;         \
  }                                                                            \
  Reals kernel_slope(Reals q) {                                                \
    const Reals rest = 1 - q;                                                  \
    return q < 0.5f ? 2 - 3 * q : rest * rest / q;                             \
  }
#else
#define DEFINE_KERNEL(Reals, kernel_value, kernel_slope)                       \
  Reals kernel_value(Reals q) {                                                \
    const Reals rest = 1 - q;                                                  \
    const Reals rest2 = rest * rest;                                           \
    return rest2 * rest2 * (4 * q + 1);                                        \
  }                                                                            \
  Reals kernel_slope(Reals q) {                                                \
    const Reals rest = 1 - q;                                                  \
    return rest * rest * rest;                                                 \
  }
#endif
DEFINE_KERNEL(real, kernel_value, kernel_slope)
#if LANES > 1
DEFINE_KERNEL(float16, kernel_values, kernel_slopes)
#endif

// A mirror: for each axis 0, or 1 for the lower wall, or 2 for the upper wall. Along a periodic axis,
// 1 and 2 are shifts across these sides.
typedef struct {
  int axes[3];
} Mirror;

// Whether a mirror reverses the direction of an axis.
bool reverses(const Parameters* p, const Mirror* m, int axis) {
  return m->axes[axis] > 0 && p->periods[axis] == 0;
}

bool is_shift(const Parameters* p, const Mirror* m) {
  return !reverses(p, m, 0) && !reverses(p, m, 1) && !reverses(p, m, 2);
}

coord reflected(const Parameters* p, const Mirror* m, coord place, int axis) {
  if (m->axes[axis] == 0) return place;
  const coord period = p->periods[axis];
  if (period > 0) return m->axes[axis] == 1 ? place + period : place - period;
  return (m->axes[axis] == 1 ? p->twice_low[axis] : p->twice_high[axis]) - place;
}

// Bit 2 k + 1 of the result: the lower side across axis k is within a support radius. Bit 2 k + 2:
// the upper side.
int sides_near(const Parameters* p, const coord* n) {
  const coord twice_reach = 2 * p->support;
  int near = 0;
  for (int k = 0; k < 3; ++k) {
    if (((p->sides >> (2 * k)) & 1) && 2 * n[k] - p->twice_low[k] < twice_reach) near |= 2 << (2 * k);
    if (((p->sides >> (2 * k + 1)) & 1) && p->twice_high[k] - 2 * n[k] < twice_reach) {
      near |= 4 << (2 * k);
    }
  }
  return near;
}

// Whether the sides of a mirror are among those of sides_near().
bool is_near(const Mirror* m, int sides) {
  bool near = true;
  for (int k = 0; k < 3; ++k) {
    near = near && (m->axes[k] == 0 || ((sides >> (2 * k + m->axes[k])) & 1));
  }
  return near;
}

// Runs BODY for each mirror `m` with these sides, also for no reflection.
#define FOR_EACH_MIRROR_IN(sides, BODY)                                        \
  {                                                                            \
    const int near = sides;                                                    \
    Mirror m;                                                                  \
    for (m.axes[0] = 0; m.axes[0] < 3; ++m.axes[0]) {                          \
      if (m.axes[0] != 0 && !((near >> m.axes[0]) & 1)) continue;              \
      for (m.axes[1] = 0; m.axes[1] < 3; ++m.axes[1]) {                        \
        if (m.axes[1] != 0 && !((near >> (2 + m.axes[1])) & 1)) continue;      \
        for (m.axes[2] = 0; m.axes[2] < 3; ++m.axes[2]) {                      \
          if (m.axes[2] != 0 && !((near >> (4 + m.axes[2])) & 1)) continue;    \
          BODY                                                                 \
        }                                                                      \
      }                                                                        \
    }                                                                          \
  }

// Runs BODY for each mirror `m` whose images may be near the position n: also for no reflection.
#define FOR_EACH_MIRROR(p, n, BODY) FOR_EACH_MIRROR_IN(sides_near(p, n), BODY)

// Runs BODY for each row of cells near the position `at`, with the slots [begin, end).
#define FOR_EACH_ROW(p, at, begins, BODY)                                      \
  {                                                                            \
    int low[3];                                                                \
    int high[3];                                                               \
    for (int k = 0; k < 3; ++k) {                                              \
      const coord c = at[k] >> (p)->cell_bits;                                 \
      const coord last = (p)->cells[k] - 1;                                    \
      low[k] = clamp(c - (p)->reach, (coord)0, last);                          \
      high[k] = clamp(c + (p)->reach, (coord)0, last);                         \
    }                                                                          \
    FOR_EACH_ROW_IN(p, low, high, begins, BODY)                                \
  }

// The part of the relative density that a particle and its own images have in excess of 1.
real own_excess(const Parameters* p, const coord* n, real weight) {
  real own = 1;
  FOR_EACH_MIRROR(p, n, {
    if (m.axes[0] + m.axes[1] + m.axes[2] == 0) continue;
    real square = 0;
    for (int k = 0; k < 3; ++k) {
      const real way = (real)(n[k] - reflected(p, &m, n[k], k)) * p->in_supports;
      square += way * way;
    }
    if (square < 1) own += kernel_value(sqrt(square));
  })
  return max((real)0, weight * own - 1);
}

// Lists of neighbours: entry k of slot s is entry_of(s, k). An entry is the slot of the neighbour
// and, in the bits from MIRROR_BITS on, the axes of the mirror. Images follow the other neighbours. A
// list with more than p.list_length neighbours is incomplete.
#if LANES > 1
#define LIST_GROUP LANES
#else
#define LIST_GROUP 32
#endif
#define MIRROR_BITS 26
#define SLOT_MASK ((1u << MIRROR_BITS) - 1)

int entry_of(const Parameters* p, int slot, int k) {
  return ((slot / LIST_GROUP) * p->list_length + k) * LIST_GROUP + slot % LIST_GROUP;
}

uint code_of(const Mirror* m) {
  return (uint)(m->axes[0] + 4 * m->axes[1] + 16 * m->axes[2]) << MIRROR_BITS;
}

Mirror mirror_of(uint code) {
  Mirror m;
  for (int k = 0; k < 3; ++k) m.axes[k] = (code >> (MIRROR_BITS + 2 * k)) & 3;
  return m;
}

// Runs BODY for each source `j` in the cells near a particle at n. `code` is the code of the mirror
// of the image, or 0. `at` is the position n, or its reflection in this mirror.
#define FOR_EACH_CANDIDATE(p, n, begins, BODY)                                 \
  FOR_EACH_MIRROR(p, n, {                                                      \
    coord at[3];                                                                 \
    for (int k = 0; k < 3; ++k) at[k] = reflected(p, &m, n[k], k);             \
    const uint code = code_of(&m);                                             \
    FOR_EACH_ROW(p, at, begins, {                                              \
      for (int j = begin; j < end; ++j) BODY                                   \
    })                                                                         \
  })

// Runs BODY for each source `j` that may be near the particle in `slot` at n. `code` is the code of
// the mirror of the image, or 0.
#define FOR_EACH_NEIGHBOUR(p, slot, n, begins, counts, lists, BODY)            \
  if (counts[slot] <= (p)->list_length) {                                        \
    const int length = counts[slot];                                           \
    for (int entry = 0; entry < length; ++entry) {                             \
      const uint listed = lists[entry_of(p, slot, entry)];                     \
      const int j = listed & SLOT_MASK;                                        \
      const uint code = listed & ~SLOT_MASK;                                   \
      BODY                                                                     \
    }                                                                          \
  } else {                                                                     \
    FOR_EACH_CANDIDATE(p, n, begins, BODY)                                     \
  }

// Adds a source to a list.
void list(const Parameters* p, global uint* lists, int slot, int* count, int source, uint code) {
  if (*count < p->list_length) lists[entry_of(p, slot, *count)] = source | code;
  ++*count;
}

// The vector from a source to a target, or to its image at `at`, in support radii.
real3 way_to(const Parameters* p, const coord* at, place4 source) {
  return (real3)((real)(at[0] - source.x), (real)(at[1] - source.y), (real)(at[2] - source.z)) *
         p->in_supports;
}

// The direction x from the image in a mirror, seen from the particle that is not reflected.
real3 turned(const Parameters* p, uint code, real3 x) {
  if (code == 0) return x;
  const Mirror m = mirror_of(code);
  return (real3)(reverses(p, &m, 0) ? -x.x : x.x, reverses(p, &m, 1) ? -x.y : x.y,
                  reverses(p, &m, 2) ? -x.z : x.z);
}

// The vector from a source, or from its image, to a target at n, in support radii.
real3 way_from(const Parameters* p, uint code, const coord* n, place4 source) {
  if (code == 0) return way_to(p, n, source);
  const Mirror m = mirror_of(code);
  coord at[3];
  for (int k = 0; k < 3; ++k) at[k] = reflected(p, &m, n[k], k);
  return turned(p, code, way_to(p, at, source));
}

real square_of(real3 x) {
  return x.x * x.x + x.y * x.y + x.z * x.z;
}

