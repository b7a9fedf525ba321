// Motion of bodies of particles, for the checks of sleep.

// Finds for each body the square of the greatest speed, the greatest coordinates, and the least
// coordinates with the opposite sign. One group for each body.
kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void find_body_motions(
    global const int2* ranges, global const double* position, global const double* velocity,
    global double* motions) {
  enum { kValues = 7 };
  local double greatest[kValues * GROUP];
  const int b = get_group_id(0);
  const int t = get_local_id(0);
  const int2 range = ranges[b];
  double own[kValues];
  own[0] = 0;
  for (int k = 1; k < kValues; ++k) own[k] = -INFINITY;
  for (int i = range.x + t; i < range.y; i += GROUP) {
    const global double* v = velocity + 3 * i;
    own[0] = greater(own[0], v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; ++k) {
      const double x = position[3 * i + k];
      own[1 + k] = greater(own[1 + k], x);
      own[4 + k] = greater(own[4 + k], -x);
    }
  }
  for (int k = 0; k < kValues; ++k) greatest[k * GROUP + t] = own[k];
  for (int width = GROUP / 2; width > 0; width /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int k = 0; t < width && k < kValues; ++k) {
      const int slot = k * GROUP + t;
      greatest[slot] = greater(greatest[slot], greatest[slot + width]);
    }
  }
  if (t != 0) return;
  for (int k = 0; k < kValues; ++k) motions[kValues * b + k] = greatest[k * GROUP];
}
