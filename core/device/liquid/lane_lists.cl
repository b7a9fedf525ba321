// Lists of the neighbours of the particles in LANES consecutive slots. The search compares a target
// with up to 16 sources at once.

#if LANES > 1

// Greatest number of neighbours in a list.
#define MOST_NEIGHBOURS 256

// Entries between the starts of two lists during the search. A vector may follow the last entry.
#define OPEN_LIST (MOST_NEIGHBOURS + 8)

// Adds the sources first + l for the set bits l of a byte to a list with `count` neighbours. Returns
// the new number. `selected` has the positions of the set bits of each byte.
INLINE int append(uint* list, int count, uint byte, uint first, global const uchar* selected) {
  const uint8 found = convert_uint8(vload8(byte, selected)) + first;
  vstore8(found, 0, list + min(count, MOST_NEIGHBOURS));
  return count + popcount(byte);
}

// The positions of some targets, or of their images in one mirror.
typedef struct {
  int count;
  int lane[LANES];
  int x[LANES];
  int y[LANES];
  int z[LANES];
} Targets;

// The first and the last cell near some positions along an axis.
INLINE int2 cells_near(const Parameters* p, int axis, int count, const int* places) {
  int low = places[0];
  int high = places[0];
  for (int t = 1; t < count; ++t) {
    low = min(low, places[t]);
    high = max(high, places[t]);
  }
  const int last = p->cells[axis] - 1;
  return (int2)(clamp((low >> p->cell_bits) - p->reach, 0, last),
                clamp((high >> p->cell_bits) + p->reach, 0, last));
}

// Compares targets with the sources begin0 + l and begin1 + l for l < 8, up to the ends of their
// rows. Adds those within a support radius to the lists.
INLINE void list_sources(const Parameters* p, const Targets* targets, int begin0, int end0,
                         int begin1, int end1, uint code, global const int* columns,
                         global const uchar* selected, uint* lists, int* counts) {
  const int stride = p->count + p->solids + COLUMN_END;
  const float reach2 = (float)p->support * p->support;
  const int16 steps = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 4, 5, 6, 7);
  const int16 is_source = steps < (int16)((int8)(end0 - begin0), (int8)(end1 - begin1));
  global const int* row0 = columns + begin0;
  global const int* row1 = columns + begin1;
  const int16 xs = (int16)(vload8(0, row0), vload8(0, row1));
  const int16 ys = (int16)(vload8(0, row0 + stride), vload8(0, row1 + stride));
  const int16 zs = (int16)(vload8(0, row0 + 2 * stride), vload8(0, row1 + 2 * stride));
  for (int t = 0; t < targets->count; ++t) {
    const float16 x = convert_float16(targets->x[t] - xs);
    const float16 y = convert_float16(targets->y[t] - ys);
    const float16 z = convert_float16(targets->z[t] - zs);
    const char16 bits = convert_char16(x * x + y * y + z * z < reach2 && is_source);
    const int lane = targets->lane[t];
    uint* list = lists + lane * OPEN_LIST;
    int count = append(list, counts[lane], byte_of(bits.lo), (uint)begin0 | code, selected);
    if (begin1 < end1) {
      count = append(list, count, byte_of(bits.hi), (uint)begin1 | code, selected);
    }
    counts[lane] = count;
  }
}

// Adds the sources near the targets to their lists, in the order of rows. A row has the same cells
// for all targets.
INLINE void list_near(const Parameters* p, const Targets* targets, uint code,
                      global const int* begins, global const int* columns,
                      global const uchar* selected, uint* lists, int* counts) {
  const int2 along_x = cells_near(p, 0, targets->count, targets->x);
  const int2 along_y = cells_near(p, 1, targets->count, targets->y);
  const int2 along_z = cells_near(p, 2, targets->count, targets->z);
  const int length = p->cells[0];
  const int width = along_x.y - along_x.x + 1;
  for (int z = along_z.x; z <= along_z.y; ++z) {
    global const int* row = begins + (z * p->cells[1] + along_y.x) * length + along_x.x;
    for (int y = along_y.x; y <= along_y.y; ++y, row += length) {
      int begin0 = row[0];
      const int end0 = row[width];
      int begin1 = begin0 + 8;
      int end1 = end0;
      if (y < along_y.y && end0 <= begin1 && row[length + width] - row[length] <= 8) {
        // Two short rows.
        row += length;
        ++y;
        begin1 = row[0];
        end1 = row[width];
      }
      for (; begin0 < end0 || begin1 < end1; begin0 += 16, begin1 += 16) {
        list_sources(p, targets, begin0, end0, begin1, end1, code, columns, selected, lists,
                     counts);
      }
    }
  }
}

// The number of small cells along x whose particles are searched together: the rows around them have
// about 8 particles.
#define SMALL_CELLS 4

// Lists the neighbours of the particles in the slots [begin, end), which are in the same cell, or in
// SMALL_CELLS cells. Element l of counts and plain_counts belongs to slot first + l.
INLINE void list_neighbours_of_cells(const Parameters* p, int first, int begin, int end,
                                     global const int* begins, global const int4* sorted_place,
                                     global const int* columns, global const uchar* selected,
                                     uint* lists, int* counts, int* plain_counts) {
  int sides[LANES];
  int all_sides = 0;
  for (int slot = begin; slot < end; ++slot) {
    const int4 own = sorted_place[slot];
    const int n[3] = {own.x, own.y, own.z};
    sides[slot - first] = sides_near(p, n);
    all_sides |= sides[slot - first];
  }
  FOR_EACH_MIRROR_IN(all_sides, {
    Targets targets;
    targets.count = 0;
    for (int slot = begin; slot < end; ++slot) {
      if (!is_near(&m, sides[slot - first])) continue;
      const int4 own = sorted_place[slot];
      const int t = targets.count++;
      targets.lane[t] = slot - first;
      targets.x[t] = reflected(p, &m, own.x, 0);
      targets.y[t] = reflected(p, &m, own.y, 1);
      targets.z[t] = reflected(p, &m, own.z, 2);
    }
    if (targets.count == 0) continue;
    const uint code = code_of(&m);
    list_near(p, &targets, code, begins, columns, selected, lists, counts);
    if (code != 0) continue;
    for (int lane = begin - first; lane < end - first; ++lane) plain_counts[lane] = counts[lane];
  })
}

// Lists the neighbours of the particles in LANES slots from `first` on. plain_counts are the numbers
// of those that are not images. Each list continues with its own slot, up to the length of the
// longest of these lists.
void list_neighbours(const Parameters* p, int first, global const int* begins,
                     global const int4* sorted_place, global const int* columns,
                     global const uchar* selected, global int* counts, global int* plain_counts,
                     global uint* lists) {
  const int end = min(first + LANES, p->count + p->solids);
  uint open[LANES * OPEN_LIST];
  int all[LANES] = {0};
  int plain[LANES] = {0};
  for (int begin = first; begin < end;) {
    const int4 own = sorted_place[begin];
    const int rest = p->cells[0] - cell_along(own.x, p->cells[0], p->cell_bits);
    const int cells = min(p->reach > 1 ? SMALL_CELLS : 1, rest);
    const int next = min(end, begins[cell_at(p, own) + cells]);
    list_neighbours_of_cells(p, first, begin, next, begins, sorted_place, columns, selected, open,
                             all, plain);
    begin = next;
  }
  int longest = 0;
  for (int lane = 0; lane < LANES; ++lane) {
    counts[first + lane] = all[lane];
    plain_counts[first + lane] = plain[lane];
    longest = max(longest, min(all[lane], p->list_length));
  }
  for (int lane = 0; lane < LANES; ++lane) {
    const uint own = min(first + lane, end - 1);
    for (int k = all[lane]; k < longest; ++k) open[lane * OPEN_LIST + k] = own;
  }
  global uint* to = lists + first * p->list_length;
  for (int k = 0; k < longest; ++k) {
    for (int lane = 0; lane < LANES; ++lane) to[k * LANES + lane] = open[lane * OPEN_LIST + k];
  }
}
#endif
