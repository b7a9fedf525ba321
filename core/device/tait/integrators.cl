// The integrators of a weakly compressible liquid without a closing kick, see solid/integrators.cl. `p`
// are the parameters at the end of a step of `dt`. The transport velocity moves the particles if
// `has_transport` is set.

double transport_of(const int has_transport, global const real4* transport, int i, int k) {
  if (!has_transport) return 0;
  const real4 w = transport[i];
  const real by[3] = {w.x, w.y, w.z};
  return by[k];
}

double acceleration_along(global const real4* acceleration, int i, int k) {
  const real4 a = acceleration[i];
  const real of[3] = {a.x, a.y, a.z};
  return of[k];
}

// Checks a particle at the end of a step, and reflects it at walls.
void end_liquid_step(const Parameters* p, int i, double3 x, double3 v, global double* position,
                     global double* velocity, global int* status) {
  bool sound = is_sound(p, x, v);
  if (reflect_at_walls(p, &x, &v)) {
    atomic_inc(status + kStops);
    sound = sound && is_sound(p, x, v);
  }
  if (!sound) atomic_or(status + kFault, 1);
  vstore3(x, i, position);
  vstore3(v, i, velocity);
}

// Takes a step of symplectic Euler.
kernel void take_liquid_euler_step(const Parameters p, const double dt, const int has_transport,
                                   global double* position, global double* velocity,
                                   global const real4* acceleration,
                                   global const real4* transport, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  const double3 v = vload3(i, velocity) + dt * convert_double3(acceleration[i].xyz);
  const double3 w = (double3)(transport_of(has_transport, transport, i, 0),
                              transport_of(has_transport, transport, i, 1),
                              transport_of(has_transport, transport, i, 2));
  const double3 x = vload3(i, position) + dt * (v + w);
  end_liquid_step(&p, i, x, v, position, velocity, status);
}

// Adds `weight` times the present rates to the sums, and moves to the next stage; see advance_stage.
kernel void advance_liquid_stage(const int count, const double weight, const double way,
                                 const int has_transport, global double* position,
                                 global double* velocity, global const double* start_position,
                                 global const double* start_velocity,
                                 global double* sum_of_velocity,
                                 global double* sum_of_acceleration,
                                 global const real4* acceleration,
                                 global const real4* transport) {
  const int i = get_global_id(0);
  if (i >= count) return;
  for (int k = 0; k < 3; ++k) {
    const int n = 3 * i + k;
    const double v = velocity[n] + transport_of(has_transport, transport, i, k);
    const double a = acceleration_along(acceleration, i, k);
    sum_of_velocity[n] += weight * v;
    sum_of_acceleration[n] += weight * a;
    position[n] = start_position[n] + way * v;
    velocity[n] = start_velocity[n] + way * a;
  }
}

// Ends a step by the sums of its rates.
kernel void end_liquid_stages(const Parameters p, const double dt, global double* position,
                              global double* velocity, global const double* start_position,
                              global const double* start_velocity,
                              global const double* sum_of_velocity,
                              global const double* sum_of_acceleration, global int* status) {
  const int i = get_global_id(0);
  if (i >= p.count) return;
  const double3 x = vload3(i, start_position) + dt * vload3(i, sum_of_velocity);
  const double3 v = vload3(i, start_velocity) + dt * vload3(i, sum_of_acceleration);
  end_liquid_step(&p, i, x, v, position, velocity, status);
}
