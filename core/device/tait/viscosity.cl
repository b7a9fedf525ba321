// The solve for the viscosity of a weakly compressible liquid, with the kernels of damping.cl. The vectors
// are in the order of particles. Solids are at rest.

// Sets the forces at the velocities `predicted`, which are those of the sums over pairs.
kernel void begin_viscosity(const Parameters p, global const int* order,
                            global const int4* sorted_place, global const float4* sorted_motion,
                            global const float4* acceleration, global const double* mass,
                            global double* predicted, global double* force) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids || is_solid(sorted_place[slot])) return;
  const int i = order[slot];
  const float4 v = sorted_motion[slot];
  const float4 a = acceleration[i];
  store_vector((double3)(v.x, v.y, v.z), predicted, i);
  store_vector(mass[i] * (double3)(a.x, a.y, a.z), force, i);
}

// Copies the direction of an iteration in the order of cells, with pressures of 0.
kernel void sort_direction(const Parameters p, global const DampingProgress* progress,
                           global const int* order, global const int4* sorted_place,
                           global const double* direction, global float4* sorted_direction) {
  const int slot = get_global_id(0);
  if (slot >= p.count + p.solids || !progress->is_open) return;
  float4 own = 0;
  if (!is_solid(sorted_place[slot])) {
    const double3 d = vector_at(direction, order[slot]);
    own = (float4)((float)d.x, (float)d.y, (float)d.z, 0);
  }
  sorted_direction[slot] = own;
}

// Computes D times the direction, and <d, (M - dt D) d>. In `p`, only forces that depend on velocities
// act, and walls are at rest.
kernel __attribute__((reqd_work_group_size(ITEMS, 1, 1))) void multiply_viscosity(
    const Parameters p, const Damping damping, global const DampingProgress* progress,
    global const int* begins, global const int* order, global const int4* sorted_place,
    global const float4* sorted_direction, global const int* counts,
    global const int* plain_counts, global const uint* lists, global const double* mass,
    global const double* direction, global double* multiplied, global double4* partial) {
  local double4 sums[GROUP];
  if (!progress->is_open) return;
  const int first = LANES * get_global_id(0);
  const int end = p.count + p.solids;
  float3 a[LANES];
  if (first < end) {
    find_accelerations(&p, first, begins, sorted_place, sorted_direction, counts, plain_counts,
                       lists, a);
  }
  for (int lane = 0; lane < LANES; ++lane) {
    const int slot = first + lane;
    double4 own = 0;
    if (slot < end && !is_solid(sorted_place[slot])) {
      const int i = order[slot];
      const double3 force = mass[i] * (double3)(a[lane].x, a[lane].y, a[lane].z);
      const double3 d = vector_at(direction, i);
      store_vector(force, multiplied, i);
      own.x = product(d, mass[i] * d - damping.dt * force);
    }
    sums[LANES * get_local_id(0) + lane] = own;
  }
  write_partial_of_lanes(sums, partial);
}

// Adds the changes of the forces to the accelerations.
kernel void end_viscosity(const int count, global const double* mobility,
                          global const double* change_of_force, global float4* acceleration) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const double3 change = mobility[i] * vector_at(change_of_force, i);
  const float4 a = acceleration[i];
  acceleration[i] = (float4)((float)(a.x + change.x), (float)(a.y + change.y),
                             (float)(a.z + change.z), 0);
}
