// A step of an incompressible liquid; see core/liquid/incompressible/volume_solve.h. The solves are
// in solve.cl.

// Enters the particles into their cells. If `is_held` is true, the particles drift first, and those
// beyond a wall are moved back.
kernel void place(const Parameters p, const int is_held, global double* position,
                  global double* velocity, global const float* weight, global int4* place,
                  global float4* motion, global int* cell_of, global int* rank,
                  global int* cell_counts, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  double3 v = vload3(i, velocity);
  double3 x = vload3(i, position) + p.drift * v;
  if (is_held) {
    if (reflect_at_walls(&p, &x, &v)) atomic_inc(status + kStops);
    vstore3(x, i, position);
    vstore3(v, i, velocity);
  }
  enter_cell(&p, i, x, convert_float3(v), weight, place, motion, cell_of, rank, cell_counts,
             status);
}

// Checks the state at the end of a step.
kernel void check(const Parameters p, global const double* position,
                  global const double* velocity, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  if (!is_sound(&p, vload3(i, position), vload3(i, velocity))) atomic_or(status + kFault, 1);
}

// Sums over the neighbours of a particle: sum_j a_j w, sum_j a_j g x, and sum_j a_j g^2 q^2, with the
// names of PairSums. Solids count twice in the second sum, and not in the third one.
typedef struct {
  float density;
  float3 gradient;
  float squares;
} VolumeSums;

// Adds the parts of a source or of its image to the sums. Returns whether it is near.
bool add_volume(const Parameters* p, uint code, const int* at, int4 source, VolumeSums* sums) {
  const float3 x = way_to(p, at, source);
  const float square = square_of(x);
  if (!(square < 1)) return false;
  const float q = sqrt(square);
  const float slope = kernel_slope(q);
  const float share = weight_of(source) * slope;
  sums->density += weight_of(source) * kernel_value(q);
  if (is_solid(source)) {
    sums->gradient += 2 * share * turned(p, code, x);
  } else {
    sums->gradient += share * turned(p, code, x);
    sums->squares += share * slope * square;
  }
  return true;
}

VolumeSums volume_sums_of(const Parameters* p, const int* n, global const int* begins,
                          global const int4* sorted_place) {
  VolumeSums sums = {0, 0, 0};
  FOR_EACH_CANDIDATE(p, n, begins, { add_volume(p, code, at, sorted_place[j], &sums); })
  return sums;
}

#if LANES > 1
// Finds the sums of the particles in LANES slots from `first` on.
void find_volume_sums(const Parameters* p, int first, global const int* begins,
                      global const int4* sorted_place, global const int* counts,
                      global const int* plain_counts, global const uint* lists,
                      VolumeSums* sums) {
  global const float4* places = (global const float4*)sorted_place;
  const Columns own = columns_at(places, first);
  float16 density = 0;
  float16 gx = 0;
  float16 gy = 0;
  float16 gz = 0;
  float16 squares = 0;
  FOR_EACH_LISTED(p, first, counts, plain_counts, lists, {
    const Columns source = gather(places, offsets);
    const Ways x = ways_from(p, listed, has_images, own, source);
    const float16 q = sqrt(x.square);
    const float16 slope = kernel_slopes(q);
    const float16 weight = select(0.0f, fabs(source.w), is_listed);
    const float16 share = weight * slope;
    density += weight * kernel_values(q);
    const int16 is_solid = source.w < 0;
    const float16 twice = select(share, 2 * share, is_solid);
    gx += twice * x.x;
    gy += twice * x.y;
    gz += twice * x.z;
    squares += select(share * slope * x.square, 0.0f, is_solid);
  })
  float all[5][LANES];
  vstore16(density, 0, all[0]);
  vstore16(gx, 0, all[1]);
  vstore16(gy, 0, all[2]);
  vstore16(gz, 0, all[3]);
  vstore16(squares, 0, all[4]);
  for (int lane = 0; lane < LANES && first + lane < p->count + p->solids; ++lane) {
    sums[lane].density = all[0][lane];
    sums[lane].gradient = (float3)(all[1][lane], all[2][lane], all[3][lane]);
    sums[lane].squares = all[4][lane];
    if (counts[first + lane] <= p->list_length) continue;
    const int4 own_place = sorted_place[first + lane];
    const int n[3] = {own_place.x, own_place.y, own_place.z};
    sums[lane] = volume_sums_of(p, n, begins, sorted_place);
  }
}
#endif

// Lists the neighbours of each particle, and computes its relative density s. Computes the squares
// |sum_j a_j g x|^2 + a sum_j a_j g^2 q^2. Sets the fourth component of sorted_motion to pressure /
// s^2. `partial` receives the sum and the maximum of the density above the rest density.
kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void find_density(
    const Parameters p, global const int* begins, global const int* order,
    global const double* pressure, global const int4* sorted_place, global const int* columns,
    global const uchar* selected, global float4* sorted_motion, global int* counts,
    global int* plain_counts, global uint* lists, global float* density,
    global float* squares, global double4* partial) {
  local double4 excesses[GROUP];
  const int first = LANES * get_global_id(0);
  const int end = p.count + p.solids;
  VolumeSums sums[LANES];
  if (first < end) {
#if LANES > 1
    list_neighbours(&p, first, begins, sorted_place, columns, selected, counts, plain_counts,
                    lists);
    find_volume_sums(&p, first, begins, sorted_place, counts, plain_counts, lists, sums);
#else
    const int4 own = sorted_place[first];
    const int n[3] = {own.x, own.y, own.z};
    VolumeSums one = {0, 0, 0};
    int count = 0;
    FOR_EACH_CANDIDATE(&p, n, begins, {
      if (add_volume(&p, code, at, sorted_place[j], &one)) list(&p, lists, first, &count, j, code);
    })
    counts[first] = count;
    sums[0] = one;
#endif
  }
  for (int lane = 0; lane < LANES; ++lane) {
    const int slot = first + lane;
    double4 excess = 0;
    if (slot < end && !is_solid(sorted_place[slot])) {
      const int4 own = sorted_place[slot];
      const int n[3] = {own.x, own.y, own.z};
      const float weight = weight_of(own);
      float sum = sums[lane].density;
      if (sum > 1) sum -= own_excess(&p, n, weight);
      density[slot] = sum;
      squares[slot] = square_of(sums[lane].gradient) + weight * sums[lane].squares;
      const double s = sum;
      sorted_motion[slot].w = (float)(pressure[order[slot]] / (s * s));
      excess.x = greater(0, s - 1);
      excess.w = excess.x;
    }
    excesses[LANES * get_local_id(0) + lane] = excess;
  }
  write_partial_of_lanes(excesses, partial);
}

// Changes the velocities by the forces over solve.dt. The gravity is solve.gravity in place of
// p.gravity, because it is not rounded to single precision. Sets solve_motion to the velocities relative
// to the walls.
kernel void kick(const Parameters p, const Solve solve, global const int* begins,
                 global const int* order, global const int4* sorted_place,
                 global const float4* sorted_motion, global const int* counts,
                 global const int* plain_counts, global const uint* lists, global double* velocity,
                 global float4* solve_motion) {
  const int first = LANES * get_global_id(0);
  if (first >= solve.slots) return;
  float3 accelerations[LANES];
  find_accelerations(&p, first, begins, sorted_place, sorted_motion, counts, plain_counts, lists,
                     accelerations);
  for (int lane = 0; lane < LANES && first + lane < solve.slots; ++lane) {
    const int slot = first + lane;
    if (is_solid(sorted_place[slot])) {
      const float v[3] = {-(float)solve.wall_velocity[0], -(float)solve.wall_velocity[1],
                          -(float)solve.wall_velocity[2]};
      solve_motion[slot] = (float4)(v[0], v[1], v[2], 0);
      continue;
    }
    const float3 a = accelerations[lane];
    const float by[3] = {a.x, a.y, a.z};
    const int i = order[slot];
    float w[3];
    for (int k = 0; k < 3; ++k) {
      const double v = velocity[3 * i + k] + solve.dt * (solve.gravity[k] + (double)by[k]);
      velocity[3 * i + k] = v;
      w[k] = (float)(v - solve.wall_velocity[k]);
    }
    solve_motion[slot] = (float4)(w[0], w[1], w[2], 0);
  }
}

// Ends the solve of the velocities.
kernel void end_projection(const Solve solve, global const Progress* progress,
                           global const int* order, global const float* density,
                           global const double* x, global const float4* whole,
                           global double* pressure, global double* velocity) {
  const int slot = get_global_id(0);
  if (slot >= solve.slots || progress->iterations == 0) return;
  const int i = order[slot];
  if (i >= solve.count) return;
  const double s = density[slot];
  pressure[i] = x[slot] * s * s;
  const float4 a = whole[slot];
  const float by[3] = {a.x, a.y, a.z};
  for (int k = 0; k < 3; ++k) velocity[3 * i + k] += solve.dt * (double)by[k];
}

// Ends the solve of the positions.
kernel void shift_places(const Solve solve, global const int* order,
                         global const float4* whole, global double* position) {
  const int slot = get_global_id(0);
  if (slot >= solve.slots) return;
  const int i = order[slot];
  if (i >= solve.count) return;
  const float4 a = whole[slot];
  const float by[3] = {a.x, a.y, a.z};
  for (int k = 0; k < 3; ++k) position[3 * i + k] += solve.dt * solve.dt * (double)by[k];
}
