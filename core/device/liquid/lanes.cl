// Sums over the neighbours of the particles in LANES consecutive slots, in vectors. Element l of a
// vector belongs to slot first + l. The sums of a particle have the same terms in the same order as
// those of FOR_EACH_NEIGHBOUR.

#if LANES > 1

// The components of vectors, with one vector per element.
typedef struct {
  float16 x, y, z, w;
} Columns;

// Elements of two vectors in turn, from the lower or upper half of each quarter.
float16 lower_in_turn(float16 a, float16 b) {
  return (float16)(a.s0, b.s0, a.s1, b.s1, a.s4, b.s4, a.s5, b.s5, a.s8, b.s8, a.s9, b.s9, a.sc,
                   b.sc, a.sd, b.sd);
}
float16 upper_in_turn(float16 a, float16 b) {
  return (float16)(a.s2, b.s2, a.s3, b.s3, a.s6, b.s6, a.s7, b.s7, a.sa, b.sa, a.sb, b.sb, a.se,
                   b.se, a.sf, b.sf);
}
float16 even_in_turn(float16 a, float16 b) {
  const double8 c = as_double8(a);
  const double8 d = as_double8(b);
  return as_float16((double8)(c.s0, d.s0, c.s2, d.s2, c.s4, d.s4, c.s6, d.s6));
}
float16 odd_in_turn(float16 a, float16 b) {
  const double8 c = as_double8(a);
  const double8 d = as_double8(b);
  return as_float16((double8)(c.s1, d.s1, c.s3, d.s3, c.s5, d.s5, c.s7, d.s7));
}

// Converts the vectors 0, 4, 8, 12 in r0, 1, 5, 9, 13 in r1, and so on.
Columns columns_of(float16 r0, float16 r1, float16 r2, float16 r3) {
  const float16 lower01 = lower_in_turn(r0, r1);
  const float16 lower23 = lower_in_turn(r2, r3);
  const float16 upper01 = upper_in_turn(r0, r1);
  const float16 upper23 = upper_in_turn(r2, r3);
  Columns c;
  c.x = even_in_turn(lower01, lower23);
  c.y = odd_in_turn(lower01, lower23);
  c.z = even_in_turn(upper01, upper23);
  c.w = odd_in_turn(upper01, upper23);
  return c;
}

// The columns of the vectors AT(0) to AT(15).
#define COLUMNS(AT)                                                                     \
  columns_of((float16)(AT(0), AT(4), AT(8), AT(12)), (float16)(AT(1), AT(5), AT(9), AT(13)), \
             (float16)(AT(2), AT(6), AT(10), AT(14)),                                   \
             (float16)(AT(3), AT(7), AT(11), AT(15)))

// The vectors at some offsets in bytes. The offsets are volatile, so that they are loaded one by one.
// Their extraction from a vector would be slower.
Columns gather(global const float4* from, const volatile uint* offsets) {
#define AT(l) *(global const float4*)((global const char*)from + offsets[l])
  return COLUMNS(AT);
#undef AT
}

// The elements of `from` in the slots from `first` on.
Columns columns_at(global const float4* from, int first) {
#define AT(l) from[first + l]
  return COLUMNS(AT);
#undef AT
}

// The vectors from sources to targets in support radii, and their squares.
typedef struct {
  float16 x, y, z, square;
} Ways;

Ways ways_of(const Parameters* p, Columns target, Columns source) {
  Ways w;
  w.x = convert_float16(as_int16(target.x) - as_int16(source.x)) * p->in_supports;
  w.y = convert_float16(as_int16(target.y) - as_int16(source.y)) * p->in_supports;
  w.z = convert_float16(as_int16(target.z) - as_int16(source.z)) * p->in_supports;
  w.square = w.x * w.x + w.y * w.y + w.z * w.z;
  return w;
}

// The maximum of the elements.
int greatest_lane(int16 v) {
  const int8 a = max(v.lo, v.hi);
  const int4 b = max(a.lo, a.hi);
  const int2 c = max(b.lo, b.hi);
  return max(c.x, c.y);
}

// Loads memory into the cache, because the lists of the next slots are on another page of memory. The
// function prefetch() of OpenCL has no effect with PoCL.
#define PREFETCH(address)
#ifdef __has_builtin
#if __has_builtin(__builtin_prefetch)
#undef PREFETCH
#define PREFETCH(address) __builtin_prefetch(address)
#endif
#endif

// Runs BODY for each place in the lists from slot `first` on. `listed` are the entries there, and
// `offsets` are the offsets of their sources in arrays of vectors, in bytes. The elements of
// `is_listed` are -1 for slots with a neighbour at this place. For the others, the source is the
// particle itself. `has_images` is false if no neighbour at this place is an image. Incomplete lists
// count as empty.
#define FOR_EACH_LISTED(p, first, counts, plain_counts, lists, BODY)               \
  {                                                                            \
    const int16 all = vload16(0, counts + first);                              \
    const int16 length = select(all, 0, all > (p)->list_length);                   \
    const int16 plain = vload16(0, plain_counts + first);                      \
    const int shortest = -greatest_lane(select(-plain, -(p)->list_length, plain >= length)); \
    const int longest = greatest_lane(length);                                 \
    for (int k = 0; k < longest; ++k) {                                        \
      const int16 is_listed = k < length;                                      \
      const bool has_images = k >= shortest;                                   \
      const uint16 listed = vload16(k, lists + first * (p)->list_length);         \
      PREFETCH(lists + (first + LANES) * (p)->list_length + k * LANES);        \
      uint offsets[LANES];                                                     \
      vstore16((listed & SLOT_MASK) * (uint)sizeof(float4), 0, offsets);       \
      BODY                                                                     \
    }                                                                          \
  }

// The axes of mirrors, see Mirror.
typedef struct {
  int16 axes[3];
} Mirrors;

Mirrors mirrors_of(uint16 listed) {
  Mirrors m;
  for (int k = 0; k < 3; ++k) m.axes[k] = as_int16((listed >> (MIRROR_BITS + 2 * k)) & 3);
  return m;
}

// The functions reverses() and reflected() for vectors.
int16 reverse(const Parameters* p, const Mirrors* m, int axis) {
  return p->periods[axis] == 0 ? m->axes[axis] > 0 : 0;
}
int16 reflections(const Parameters* p, const Mirrors* m, int16 places, int axis) {
  const int16 is_low = m->axes[axis] == 1;
  const int period = p->periods[axis];
  const int16 images =
      period > 0 ? select(places - period, places + period, is_low)
                 : select((int16)p->twice_high[axis], (int16)p->twice_low[axis], is_low) - places;
  return select(places, images, m->axes[axis] != 0);
}

// The positions of the images of targets.
Columns images_of(const Parameters* p, const Mirrors* m, Columns targets) {
  Columns at = targets;
  at.x = as_float16(reflections(p, m, as_int16(targets.x), 0));
  at.y = as_float16(reflections(p, m, as_int16(targets.y), 1));
  at.z = as_float16(reflections(p, m, as_int16(targets.z), 2));
  return at;
}

// The function way_from() for the entries `listed`.
Ways ways_from(const Parameters* p, uint16 listed, bool has_images, Columns target,
               Columns source) {
  if (!has_images) return ways_of(p, target, source);
  const Mirrors m = mirrors_of(listed);
  Ways w = ways_of(p, images_of(p, &m, target), source);
  w.x = select(w.x, -w.x, reverse(p, &m, 0));
  w.y = select(w.y, -w.y, reverse(p, &m, 1));
  w.z = select(w.z, -w.z, reverse(p, &m, 2));
  return w;
}
#endif
