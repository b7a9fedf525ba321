// Forces of pairs of particles; see core/liquid/tait/weakly_compressible.h for the method.

// The pressure of the image of a particle at `place` includes the hydrostatic pressure difference;
// see ImagePressure.
real image_pressure(const Parameters* p, const Mirror* m, place4 place, real pressure) {
  if (!p->is_filled && pressure <= 0) return pressure;
  const coord n[3] = {place.x, place.y, place.z};
  real more = 0;
  for (int k = 0; k < 3; ++k) {
    if (p->periods[k] > 0) continue;
    more += p->fall[k] * ((real)(reflected(p, m, n[k], k) - n[k]) * p->unit);
  }
  if (p->is_filled) return pressure + p->density * more;
  return max((real)0, pressure + pressure / (pressure + p->layer) * (p->density * more));
}

// Avoids a division by 0 in viscous forces: (h/2)^2 / 100 in units of the support radius h.
#define SOFTENING ((real)0.01 / 4)

// The force of a pair without its factor x. `approach` is the product of x and the relative velocity.
#define DEFINE_SHARE_OF_FORCE(Reals, share_of_force, kernel_slope)                              \
  Reals share_of_force(const Parameters* p, Reals approach, Reals square, Reals pressures,      \
                       Reals weight) {                                                         \
    const Reals force = p->viscosity * approach / (square + SOFTENING) - pressures;            \
    return force * (weight * kernel_slope(sqrt(square)));                                      \
  }
DEFINE_SHARE_OF_FORCE(real, share_of_force, kernel_slope)

// Adds the force of a source on a target.
void add_force(const Parameters* p, const coord* n, real4 mine, place4 source, real4 its,
               real* sum) {
  const real3 x = way_to(p, n, source);
  const real square = square_of(x);
  if (!(square < 1)) return;
  const real approach = (mine.x - its.x) * x.x + (mine.y - its.y) * x.y + (mine.z - its.z) * x.z;
  const real share = share_of_force(p, approach, square, mine.w + its.w, weight_of(source));
  sum[0] += share * x.x;
  sum[1] += share * x.y;
  sum[2] += share * x.z;
}

// The velocity of the image of a particle with the velocity v, see mirrored_velocity().
real3 mirrored_velocity(const Parameters* p, const Mirror* m, real4 motion) {
  real v[3] = {motion.x, motion.y, motion.z};
  for (int axis = 0; axis < 3; ++axis) {
    if (!reverses(p, m, axis)) continue;
    const int wall = 2 * axis + m->axes[axis] - 1;
    const bool has_no_slip = (p->no_slip >> wall) & 1;
    for (int k = 0; k < 3; ++k) {
      const real of_wall = p->speeds_of_walls[3 * wall + k];
      if (k == axis || has_no_slip) v[k] = -(v[k] - of_wall) + of_wall;
    }
  }
  return (real3)(v[0], v[1], v[2]);
}

// Whether images in this mirror are viscous, see add_viscous_image_forces().
bool is_viscous(const Parameters* p, const Mirror* m) {
  int walls = 0;
  for (int k = 0; k < 3; ++k) walls |= m->axes[k] > 0 ? 1 << (2 * k + m->axes[k] - 1) : 0;
  return p->is_thick || (walls & p->no_slip);
}

// Adds the force of the reflection of a source on a target. A solid has no viscous force of images.
void add_force_of_image(const Parameters* p, const Mirror* m, const coord* n, int is_target_solid,
                        real4 mine, place4 source, real4 its, real* sum) {
  coord at[3];
  for (int k = 0; k < 3; ++k) at[k] = reflected(p, m, n[k], k);
  const real3 x = way_to(p, at, source);
  const real square = square_of(x);
  if (!(square < 1)) return;
  const real force = -(mine.w + image_pressure(p, m, source, its.w));
  const real share = force * (weight_of(source) * kernel_slope(sqrt(square)));
  sum[0] += share * (reverses(p, m, 0) ? -x.x : x.x);
  sum[1] += share * (reverses(p, m, 1) ? -x.y : x.y);
  sum[2] += share * (reverses(p, m, 2) ? -x.z : x.z);
  if (is_target_solid || is_solid(source) || !is_viscous(p, m)) return;
  const real3 v = mirrored_velocity(p, m, its);
  const real drag = p->viscosity / (square + SOFTENING) *
                     (weight_of(source) * kernel_slope(sqrt(square)));
  sum[0] += drag * (x.x * x.x) * (mine.x - v.x);
  sum[1] += drag * (x.y * x.y) * (mine.y - v.y);
  sum[2] += drag * (x.z * x.z) * (mine.z - v.z);
}

// Adds the force of a source, or of the image of a source, on a target.
void add_force_of(const Parameters* p, uint code, const coord* n, int is_target_solid, real4 mine,
                  place4 source, real4 its, real* sum) {
  if (code == 0) {
    add_force(p, n, mine, source, its, sum);
    return;
  }
  const Mirror m = mirror_of(code);
  if (is_shift(p, &m)) {
    coord at[3];
    for (int k = 0; k < 3; ++k) at[k] = reflected(p, &m, n[k], k);
    add_force(p, at, mine, source, its, sum);
  } else {
    add_force_of_image(p, &m, n, is_target_solid, mine, source, its, sum);
  }
}

// The acceleration by the central field at the integer position n.
real field_at(const Parameters* p, coord n, int axis) {
  const double x = p->origin[axis] + n / p->inverse_unit;
  return (real)(p->field_strength * (p->field_center[axis] - x));
}

// The acceleration of a particle by the sum over pairs, gravity, central field and settling.
real3 acceleration_by(const Parameters* p, const coord* n, real4 mine, const real* sum) {
  const real v[3] = {mine.x, mine.y, mine.z};
  real a[3];
  for (int k = 0; k < 3; ++k) {
    a[k] = p->gravity[k] + p->slope_factor * sum[k] - p->drag * (v[k] - p->still[k]);
    if (p->field_strength > 0) a[k] += field_at(p, n[k], k);
  }
  return (real3)(a[0], a[1], a[2]);
}

// The acceleration of the particle in `slot`, see acceleration_by().
real3 acceleration_of(const Parameters* p, int slot, global const int* begins,
                       global const place4* sorted_place, global const real4* sorted_motion,
                       global const int* counts, global const uint* lists LIQUIDS) {
  const place4 place = sorted_place[slot];
  const real4 mine = sorted_motion[slot];
  const coord n[3] = {place.x, place.y, place.z};
  real sum[3] = {0, 0, 0};
  COPY_PARAMETERS(own, p);
  SET_TARGET(own, slot)
  FOR_EACH_NEIGHBOUR(p, slot, n, begins, counts, lists, {
    SET_SOURCE(own, p, 0, slot, j, sorted_place[j])
    add_force_of(own, code, n, 0, mine, sorted_place[j], sorted_motion[j], sum);
  })
  return acceleration_by(own, n, mine, sum);
}

#if LANES > 1
DEFINE_SHARE_OF_FORCE(float16, shares_of_force, kernel_slopes)

// Sums over the pairs of LANES targets.
typedef struct {
  float16 x, y, z;
} Sums;

// The function image_pressure() for vectors.
float16 image_pressures(const Parameters* p, const Mirrors* m, Columns places, float16 pressure) {
  float16 more = 0;
  for (int k = 0; k < 3; ++k) {
    if (p->periods[k] > 0) continue;
    const int16 n = as_int16(k == 0 ? places.x : k == 1 ? places.y : places.z);
    more += p->fall[k] * (convert_float16(reflections(p, m, n, k) - n) * p->unit);
  }
  if (p->is_filled) return pressure + p->density * more;
  const float16 images =
      max(0.0f, pressure + pressure / (pressure + p->layer) * (p->density * more));
  return select(images, pressure, pressure <= 0);
}

// The function mirrored_velocity() for vectors.
Columns mirrored_velocities(const Parameters* p, const Mirrors* m, Columns motion) {
  float16 v[3] = {motion.x, motion.y, motion.z};
  for (int axis = 0; axis < 3; ++axis) {
    const int16 is_reverse = reverse(p, m, axis);
    const int16 is_low = m->axes[axis] == 1;
    const int16 has_no_slip = select((int16)-((p->no_slip >> (2 * axis + 1)) & 1),
                                     (int16)-((p->no_slip >> (2 * axis)) & 1), is_low);
    for (int k = 0; k < 3; ++k) {
      const float16 of_wall = select((float16)p->speeds_of_walls[6 * axis + 3 + k],
                                     (float16)p->speeds_of_walls[6 * axis + k], is_low);
      const int16 turns = k == axis ? is_reverse : is_reverse & has_no_slip;
      v[k] = select(v[k], -(v[k] - of_wall) + of_wall, turns);
    }
  }
  Columns turned = {v[0], v[1], v[2], motion.w};
  return turned;
}

// The function is_viscous() for vectors.
int16 are_viscous(const Parameters* p, const Mirrors* m) {
  if (p->is_thick) return -1;
  int16 any = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if ((p->no_slip >> (2 * axis)) & 1) any |= m->axes[axis] == 1;
    if ((p->no_slip >> (2 * axis + 1)) & 1) any |= m->axes[axis] == 2;
  }
  return any;
}

// Adds the forces of sources, or of their images in `m`.
void add_forces_of_images(const Parameters* p, const Mirrors* m, Columns own, Columns mine,
                          Columns source, Columns its, int16 is_listed, Sums* sum) {
  const Ways x = ways_of(p, images_of(p, m, own), source);
  const int16 reverse_x = reverse(p, m, 0);
  const int16 reverse_y = reverse(p, m, 1);
  const int16 reverse_z = reverse(p, m, 2);
  const int16 is_shift = ~(reverse_x | reverse_y | reverse_z);
  const float16 weight = fabs(source.w) * kernel_slopes(sqrt(x.square));
  const float16 approach =
      (mine.x - its.x) * x.x + (mine.y - its.y) * x.y + (mine.z - its.z) * x.z;
  const float16 share =
      select(-(mine.w + image_pressures(p, m, source, its.w)) * weight,
             shares_of_force(p, approach, x.square, mine.w + its.w, fabs(source.w)), is_shift);
  sum->x += select(0.0f, share * select(x.x, -x.x, reverse_x), is_listed);
  sum->y += select(0.0f, share * select(x.y, -x.y, reverse_y), is_listed);
  sum->z += select(0.0f, share * select(x.z, -x.z, reverse_z), is_listed);
  if (!p->is_thick && p->no_slip == 0) return;
  const int16 drags = is_listed & are_viscous(p, m) & ~is_shift & (source.w >= 0);
  const Columns v = mirrored_velocities(p, m, its);
  const float16 drag = p->viscosity / (x.square + SOFTENING) * weight;
  sum->x += select(0.0f, drag * (x.x * x.x) * (mine.x - v.x), drags);
  sum->y += select(0.0f, drag * (x.y * x.y) * (mine.y - v.y), drags);
  sum->z += select(0.0f, drag * (x.z * x.z) * (mine.z - v.z), drags);
}

// Finds the accelerations of the particles in LANES slots from `first` on, except of solids.
void find_accelerations(const Parameters* p, int first, global const int* begins,
                        global const place4* sorted_place, global const real4* sorted_motion,
                        global const int* counts, global const int* plain_counts,
                        global const uint* lists, real3* a) {
  global const real4* places = (global const real4*)sorted_place;
  const Columns own = columns_at(places, first);
  const Columns mine = columns_at(sorted_motion, first);
  Sums sum = {0, 0, 0};
  FOR_EACH_LISTED(p, first, counts, plain_counts, lists, {
    const Columns source = gather(places, offsets);
    const Columns its = gather(sorted_motion, offsets);
    if (has_images) {
      const Mirrors m = mirrors_of(listed);
      add_forces_of_images(p, &m, own, mine, source, its, is_listed, &sum);
      continue;
    }
    const Ways x = ways_of(p, own, source);
    const float16 approach =
        (mine.x - its.x) * x.x + (mine.y - its.y) * x.y + (mine.z - its.z) * x.z;
    const float16 share =
        shares_of_force(p, approach, x.square, mine.w + its.w, fabs(source.w));
    const float16 listed_share = select(0.0f, share, is_listed);
    sum.x += listed_share * x.x;
    sum.y += listed_share * x.y;
    sum.z += listed_share * x.z;
  })
  real sums[3][LANES];
  vstore16(sum.x, 0, sums[0]);
  vstore16(sum.y, 0, sums[1]);
  vstore16(sum.z, 0, sums[2]);
  for (int lane = 0; lane < LANES && first + lane < p->count + p->solids; ++lane) {
    const int slot = first + lane;
    const place4 place = sorted_place[slot];
    if (is_solid(place)) continue;
    if (counts[slot] > p->list_length) {
      a[lane] = acceleration_of(p, slot, begins, sorted_place, sorted_motion, counts, lists);
      continue;
    }
    const coord n[3] = {place.x, place.y, place.z};
    const real total[3] = {sums[0][lane], sums[1][lane], sums[2][lane]};
    a[lane] = acceleration_by(p, n, sorted_motion[slot], total);
  }
}
#else
void find_accelerations(const Parameters* p, int first, global const int* begins,
                        global const place4* sorted_place, global const real4* sorted_motion,
                        global const int* counts, global const int* plain_counts,
                        global const uint* lists, real3* a LIQUIDS) {
  if (first >= p->count + p->solids || is_solid(sorted_place[first])) return;
  a[0] = acceleration_of(p, first, begins, sorted_place, sorted_motion, counts,
                         lists PASS_LIQUIDS);
}
#endif

// Extrapolates the pressure of the surrounding liquid to solids, see extrapolate_pressure().
// p.gravity is the gravity on the liquid.
kernel void find_solid_pressure(const Parameters p, global const int* begins,
                                global const place4* sorted_place, global real4* sorted_motion,
                                global const real* density, global const int* counts,
                                global const uint* lists LIQUIDS) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const place4 own = sorted_place[slot];
  if (!is_solid(own)) return;
  const coord n[3] = {own.x, own.y, own.z};
  real weights = 0;
  real pressures = 0;
  real3 arms = 0;
  COPY_PARAMETERS(with, &p);
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    const place4 source = sorted_place[j];
    if (is_solid(source)) continue;
    const real3 x = way_from(&p, code, n, source);
    const real square = square_of(x);
    if (!(square < 1)) continue;
    const real weight = weight_of(source) * kernel_value(sqrt(square));
    const real s = density[j];
    real pressure = sorted_motion[j].w * (s * s);
    if (code != 0) {
      const Mirror m = mirror_of(code);
      SET_SOURCE(with, &p, 1, slot, j, source)
      pressure = image_pressure(with, &m, source, pressure);
    }
    weights += weight;
    pressures += weight * pressure;
    arms += DENSITY_WEIGHT(&p, j, weight) * x;
  })
  const real fall = p.gravity[0] * arms.x + p.gravity[1] * arms.y + p.gravity[2] * arms.z;
  const real sum = pressures + p.density * (fall * (p.unit / p.in_supports));
  const real mean = weights > 0 ? sum / weights : 0;
  sorted_motion[slot].w = p.is_filled ? mean : max((real)0, mean);
}

// The accelerations in the order of particles.
kernel void find_acceleration(const Parameters p, global const int* begins,
                              global const int* order, global const place4* sorted_place,
                              global const real4* sorted_motion, global const int* counts,
                              global const int* plain_counts, global const uint* lists,
                              global real4* acceleration LIQUIDS) {
  const int first = LANES * get_global_id(0);
  if (first >= p.count + p.solids) return;
  real3 a[LANES];
  find_accelerations(&p, first, begins, sorted_place, sorted_motion, counts, plain_counts, lists,
                     a PASS_LIQUIDS);
  for (int lane = 0; lane < LANES && first + lane < p.count + p.solids; ++lane) {
    const int slot = first + lane;
    if (is_solid(sorted_place[slot])) continue;
    acceleration[order[slot]] = (real4)(stored_acceleration(a[lane]), 0);
  }
}

// Adds the forces of the liquid on the particles of solids, see add_tait_forces_on_solids(). `force`
// is indexed by solid particle.
kernel void add_forces_on_solids(const Parameters p, global const int* begins,
                                 global const int* order, global const place4* sorted_place,
                                 global const real4* sorted_motion, global const int* counts,
                                 global const uint* lists, global double* force LIQUIDS) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids) return;
  const place4 own = sorted_place[slot];
  if (!is_solid(own)) return;
  const real4 mine = sorted_motion[slot];
  const coord n[3] = {own.x, own.y, own.z};
  real sum[3] = {0, 0, 0};
  COPY_PARAMETERS(with, &p);
  FOR_EACH_NEIGHBOUR(&p, slot, n, begins, counts, lists, {
    place4 source = sorted_place[j];
    if (is_solid(source)) continue;
    SET_SOURCE(with, &p, 1, slot, j, source)
    SET_SLOPE_WEIGHT(source, j)
    add_force_of(with, code, n, 1, mine, source, sorted_motion[j], sum);
  })
  const real factor = p.solid_factor * weight_of(own);
  for (int k = 0; k < 3; ++k) force[3 * (order[slot] - p.count) + k] += (double)(factor * sum[k]);
}
