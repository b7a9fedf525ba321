// Cells: the particles in the order of their cells, by prefix sums of the particle counts.

// Prefix sums of `values` in blocks of SCAN_BLOCK. The last one writes the total behind the end.
#define SCAN_ITEMS 4
#define SCAN_GROUP GROUP
#define SCAN_BLOCK (SCAN_ITEMS * SCAN_GROUP)

// Replaces the values of a group by the sums of the values before them. Returns the total.
int scan_group(local int* values, int own, int* before) {
  const int t = get_local_id(0);
  values[t] = own;
  barrier(CLK_LOCAL_MEM_FENCE);
#if LANES > 1
  // See COMBINE_GROUP.
  if (t == 0) {
    for (int k = 1; k < SCAN_GROUP; ++k) values[k] += values[k - 1];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
#else
  for (int width = 1; width < SCAN_GROUP; width *= 2) {
    const int other = t >= width ? values[t - width] : 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    values[t] += other;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
#endif
  *before = values[t] - own;
  return values[SCAN_GROUP - 1];
}

kernel __attribute__((reqd_work_group_size(SCAN_GROUP, 1, 1))) void sum_blocks(
    const int count, global const int* values, global int* block_sums) {
  local int sums[SCAN_GROUP];
  const int first = get_global_id(0) * SCAN_ITEMS;
  int own = 0;
  for (int k = 0; k < SCAN_ITEMS; ++k) own += first + k < count ? values[first + k] : 0;
  int before;
  const int total = scan_group(sums, own, &before);
  if (get_local_id(0) == 0) block_sums[get_group_id(0)] = total;
}

// One group.
kernel __attribute__((reqd_work_group_size(SCAN_GROUP, 1, 1))) void scan_sums(
    const int count, global int* block_sums) {
  local int sums[SCAN_GROUP];
  int carried = 0;
  for (int first = 0; first < count; first += SCAN_GROUP) {
    const int n = first + get_local_id(0);
    int before;
    const int total = scan_group(sums, n < count ? block_sums[n] : 0, &before);
    if (n < count) block_sums[n] = carried + before;
    carried += total;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

kernel __attribute__((reqd_work_group_size(SCAN_GROUP, 1, 1))) void scan_blocks(
    const int count, global const int* values, global const int* block_sums, global int* begins) {
  local int sums[SCAN_GROUP];
  const int first = get_global_id(0) * SCAN_ITEMS;
  int own[SCAN_ITEMS];
  int total = 0;
  for (int k = 0; k < SCAN_ITEMS; ++k) {
    own[k] = first + k < count ? values[first + k] : 0;
    total += own[k];
  }
  int before;
  scan_group(sums, total, &before);
  before += block_sums[get_group_id(0)];
  for (int k = 0; k < SCAN_ITEMS; ++k) {
    if (first + k < count) begins[first + k] = before;
    before += own[k];
    if (first + k == count - 1) begins[count] = before;
  }
}

kernel void scatter(const int count, global const int* cell_of, global const int* rank,
                    global const int* begins, global int* unsorted) {
  const int i = get_global_id(0);
  if (i < count) unsorted[begins[cell_of[i]] + rank[i]] = i;
}

// Runs BODY for each row of cells in the box from `low` to `high`, with the slots [begin, end).
#define FOR_EACH_ROW_IN(p, low, high, begins, BODY)                            \
  for (int z = low[2]; z <= high[2]; ++z) {                                    \
    for (int y = low[1]; y <= high[1]; ++y) {                                  \
      const int row = (z * (p)->cells[1] + y) * (p)->cells[0];                 \
      const int begin = begins[row + low[0]];                                  \
      const int end = begins[row + high[0] + 1];                               \
      BODY                                                                     \
    }                                                                          \
  }

// The position of a particle in the order of cells. Within a cell, this is the order of particles,
// because the order of atomic operations differs from run to run.
int slot_in_cell(int i, global const int* cell_of, global const int* begins,
                 global const int* unsorted) {
  const int begin = begins[cell_of[i]];
  const int end = begins[cell_of[i] + 1];
  int slot = begin;
  for (int k = begin; k < end; ++k) slot += unsorted[k] < i;
  return slot;
}
