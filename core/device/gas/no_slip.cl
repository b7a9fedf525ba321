// The liquid beyond a no-slip wall, see core/kernels/half_space.h. `q` is the distance from the wall in
// support radii. The functions of devices for angles and logarithms have different rounding errors.

// The angle in [0, pi / 2] with this cosine, by Newton's method for the sine of its half.
double angle_of_cosine(double cosine) {
  const double sine = sqrt((1 - cosine) / 2);
  double half_angle = sine * (1 + sine * sine / 6);
  for (int n = 0; n < 5; ++n) {
    const double2 at = sine_and_cosine(half_angle);
    half_angle -= (at.x - sine) / at.y;
  }
  return 2 * half_angle;
}

// The natural logarithm of a normal number x >= 1: that of its power of two, and a series for the rest.
double logarithm(double x) {
  const ulong bits = as_ulong(x);
  const int exponent = (int)(bits >> 52) - 1023;
  const double rest = as_double((bits & 0xfffffffffffffUL) | 0x3ff0000000000000UL);
  const double z = (rest - 1) / (rest + 1);  // at most 1/3
  double sum = 0;
  for (int n = 35; n >= 1; n -= 2) sum = sum * (z * z) + 1 / (double)n;
  return exponent * 0.69314718055994530942 + 2 * z * sum;
}

double filling_of_half_space(int dimensions, double distance) {
  const double q = fmax(0.0, distance);
  if (q >= 1) return 0;
  const double q2 = q * q;
  if (dimensions == 3) {
    const double sum = 1 - q2 * (4.0 / 3 - q2 * (6.0 / 5 - q2 * (4.0 / 7 - q2 / 9)));
    return fmax(0.0, 0.5 - 315.0 / 256 * q * sum);
  }
  const double sine2 = 1 - q2;
  const double sum = 1 + sine2 * (2.0 / 3 + sine2 * (8.0 / 15 + sine2 * (16.0 / 35)));
  return fmax(0.0, (angle_of_cosine(q) - q * sqrt(sine2) * sum) / 3.14159265358979323846);
}

// The drag times the square of the support radius.
double drag_of_half_space(int dimensions, double distance) {
  const double q = fmax(0.0, distance);
  if (q >= 1) return 0;
  const double least = 0.1;  // HalfSpace::kMinDistance
  double integral;
  if (dimensions == 3) {
    const double rest = 1 - q;
    integral = 0.75 * (rest * rest * rest) * (3 + q * (9 + 8 * q));
  } else {
    const double w = sqrt(1 - q * q);
    const double of_logarithm = q > 1e-30 ? q * q * q * q * logarithm((1 + w) / q) : 0;
    integral = 40 / 3.14159265358979323846 * (5 * (w * w * w) / 12 - w / 4 + of_logarithm / 4);
  }
  return fmax(0.0, integral) / fmax(q, least);
}

// The part of the support that the liquid beyond all no-slip walls fills. A space behind two walls counts
// twice.
double filling_beyond_walls(const Solids* p, int no_slip, double support, double3 place) {
  const double at[3] = {place.x, place.y, place.z};
  double filling = 0;
  for (int wall = 0; wall < 6; ++wall) {
    if (!((no_slip >> wall) & 1)) continue;
    const double distance = distance_from_wall(p, wall, at[wall / 2]);
    filling += filling_of_half_space(p->dimensions, distance / support);
  }
  return filling;
}

// The force of no-slip walls on a particle with this viscosity times volume.
double3 drag_of_walls(const Solids* p, int no_slip, double support, double viscosity,
                      double3 place, double3 velocity) {
  const double at[3] = {place.x, place.y, place.z};
  double3 force = 0;
  for (int wall = 0; wall < 6; ++wall) {
    if (!((no_slip >> wall) & 1)) continue;
    const int axis = wall / 2;
    const double* belt = p->speeds_of_walls + 3 * wall;
    const double3 of_wall = (double3)(p->wall_velocity[0] + belt[0], p->wall_velocity[1] + belt[1],
                                      p->wall_velocity[2] + belt[2]);
    const double distance = distance_from_wall(p, wall, at[axis]) / support;
    const double drag = viscosity * drag_of_half_space(p->dimensions, distance) / (support * support);
    double3 slip = velocity - of_wall;
    if (axis == 0) slip.x = 0;
    if (axis == 1) slip.y = 0;
    if (axis == 2) slip.z = 0;
    force -= drag * slip;
  }
  return force;
}
