// A step of a weakly compressible liquid; see core/liquid/tait/weakly_compressible.h.

// Ends a step: kicks the particle and checks its state.
double3 end_step(const Parameters* p, double3 x, double3 v, double3 a, global int* status) {
  const double3 after = v + p->closing * a;
  if (p->closing > 0 && !is_sound(p, x, after)) atomic_or(status + kFault, 1);
  return after;
}

// Ends a step with a kick, and begins the next one with a kick and a drift. Counts the particles of
// each cell.
kernel void move(const Parameters p, global double* position, global double* velocity,
                 global const real4* acceleration, global const real* weight,
                 global place4* place, global real4* motion, global int* cell_of, global int* rank,
                 global int* cell_counts, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  const double3 a = convert_double3(acceleration[i].xyz);
  double3 x = vload3(i, position);
  double3 v = end_step(&p, x, vload3(i, velocity), a, status);
  v += p.opening * a;
  x += p.drift * v;
  if (p.drift > 0 && reflect_at_walls(&p, &x, &v)) atomic_inc(status + kStops);
  vstore3(x, i, position);
  vstore3(v, i, velocity);
  enter_cell(&p, i, x, convert_real3(v + p.prediction * a), weight, place, motion, cell_of, rank,
             cell_counts, status);
}

// Removes the accelerations of particles in nozzles, which keep their velocities.
kernel void hold_particles(int count, global const int* held, global real4* acceleration) {
  const int n = get_global_id(0);
  if (n < count) acceleration[held[n]] = 0;
}

// Kicks the particles at the end of the last step.
kernel void finish(const Parameters p, global const double* position, global double* velocity,
                   global const real4* acceleration, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  const double3 a = convert_double3(acceleration[i].xyz);
  vstore3(end_step(&p, vload3(i, position), vload3(i, velocity), a, status), i, velocity);
}

// Pressure / (density at rest * square of the speed of sound); see tait_pressure().
real tait_pressure(real s) {
  const real end = 1.03;
  const real at_end = 0.032839123632124316;  // (end^7 - 1) / 7
  const real slope = 0.9;
  if (s > 2) return at_end + slope * (1 / end - (real)0.5 + (s - 2) / 4);
  if (s > end) return at_end + slope * (1 / end - 1 / s);
  // Equal to (s^7 - 1) / 7, without the cancellation of s^7 and 1.
  const real e = s - 1;
  return e * (1 + s * (1 + s * (1 + s * (1 + s * (1 + s * (1 + s)))))) / 7;
}

// Sets the relative density s of a liquid particle from the sum over its neighbours. Sets the fourth
// component of sorted_motion to pressure / s^2.
void set_pressure(const Parameters* p, int slot, place4 own, real sum, global real4* sorted_motion,
                  global real* density) {
  if (is_solid(own)) return;
  const coord n[3] = {own.x, own.y, own.z};
  if (sum > 1) sum -= own_excess(p, n, as_real(own.w));
  density[slot] = sum;
  const real square = sum * sum;
  const real pressure = p->stiffness * tait_pressure(sum);
  sorted_motion[slot].w =
      (p->is_filled ? pressure : max(0 - p->tension * square, pressure)) / square;
}

// The part of the density by a source, seen from the position `at`.
real density_by(const Parameters* p, const coord* at, place4 source) {
  const real square = square_of(way_to(p, at, source));
  return square < 1 ? weight_of(source) * kernel_value(sqrt(square)) : 0;
}

#if LANES > 1
// Finds the sums over the neighbours in the lists of LANES slots from `first` on.
void find_densities(const Parameters* p, int first, global const int* begins,
                    global const place4* sorted_place, global const int* counts,
                    global const int* plain_counts, global const uint* lists, real* sums) {
  global const real4* places = (global const real4*)sorted_place;
  const Columns own = columns_at(places, first);
  float16 sum = 0;
  FOR_EACH_LISTED(p, first, counts, plain_counts, lists, {
    const Columns source = gather(places, offsets);
    const Ways x = ways_from(p, listed, has_images, own, source);
    sum += select(0.0f, fabs(source.w) * kernel_values(sqrt(x.square)), is_listed);
  })
  vstore16(sum, 0, sums);
}

// Lists the neighbours of each particle, and finds its density and pressure.
kernel void find_pressure(const Parameters p, global const int* begins,
                          global const place4* sorted_place, global const int* columns,
                          global const uchar* selected, global real4* sorted_motion,
                          global real* density, global int* counts, global int* plain_counts,
                          global uint* lists) {
  const int first = LANES * get_global_id(0);
  const int end = p.count + p.solids;
  if (first >= end) return;
  list_neighbours(&p, first, begins, sorted_place, columns, selected, counts, plain_counts, lists);
  real sums[LANES];
  find_densities(&p, first, begins, sorted_place, counts, plain_counts, lists, sums);
  for (int lane = 0; lane < LANES && first + lane < end; ++lane) {
    const int slot = first + lane;
    const place4 own = sorted_place[slot];
    const coord n[3] = {own.x, own.y, own.z};
    real sum = sums[lane];
    if (counts[slot] > p.list_length) {
      sum = 0;
      FOR_EACH_CANDIDATE(&p, n, begins, { sum += density_by(&p, at, sorted_place[j]); })
    }
    set_pressure(&p, slot, own, sum, sorted_motion, density);
  }
}
#else
kernel void find_pressure(const Parameters p, global const int* begins,
                          global const place4* sorted_place, global const int* columns,
                          global const uchar* selected, global real4* sorted_motion,
                          global real* density, global int* counts, global int* plain_counts,
                          global uint* lists LIQUIDS) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  place4 own = sorted_place[slot];
  const coord n[3] = {own.x, own.y, own.z};
  real sum = 0;
  int count = 0;
  FOR_EACH_CANDIDATE(&p, n, begins, {
    const place4 other = sorted_place[j];
    const real square = square_of(way_to(&p, at, other));
    if (!(square < 1)) continue;
    sum += weight_of(other) * kernel_value(sqrt(square));
    list(&p, lists, slot, &count, j, code);
  })
  counts[slot] = count;
  COPY_PARAMETERS(with, &p);
  SET_TARGET(with, slot)
  SCALE_DENSITY(own, sum, slot)
  set_pressure(with, slot, own, sum, sorted_motion, density);
}
#endif
