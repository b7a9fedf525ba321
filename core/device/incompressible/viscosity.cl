// The kick of an incompressible liquid by accelerations from a solve for its viscosity.

// Changes the velocities by the accelerations over solve.dt; see kick. The accelerations include
// p.gravity, which is rounded to single precision.
kernel void kick_by_accelerations(const Parameters p, const Solve solve, global const int* order,
                                  global const int4* sorted_place,
                                  global const float4* acceleration, global double* velocity,
                                  global float4* solve_motion) {
  const int slot = get_global_id(0);
  if (slot >= solve.slots) return;
  if (is_solid(sorted_place[slot])) {
    const float v[3] = {-(float)solve.wall_velocity[0], -(float)solve.wall_velocity[1],
                        -(float)solve.wall_velocity[2]};
    solve_motion[slot] = (float4)(v[0], v[1], v[2], 0);
    return;
  }
  const int i = order[slot];
  const float4 a = acceleration[i];
  const float by[3] = {a.x, a.y, a.z};
  float w[3];
  for (int k = 0; k < 3; ++k) {
    const double gravity_error = solve.gravity[k] - (double)p.gravity[k];
    const double v = velocity[3 * i + k] + solve.dt * ((double)by[k] + gravity_error);
    velocity[3 * i + k] = v;
    w[k] = (float)(v - solve.wall_velocity[k]);
  }
  solve_motion[slot] = (float4)(w[0], w[1], w[2], 0);
}
