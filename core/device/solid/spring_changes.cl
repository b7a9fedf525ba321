// Plastic flow and tearing of springs, see core/solid/spring_changes.h. The table of springs has the
// present rest lengths; torn springs have neither stiffness nor damping.

// The changes of the springs of a material.
typedef struct {
  double yield_strain;
  double hardening;
  double most_strain;
  double share;            // of the stress beyond yield that flows in a step
  double greatest_stretch; // length / rest length at which springs tear; infinite without tearing
  int flows;
  int padding;
} SpringChange;

// The rest length after plastic flow, see flown_length().
double flown_length(const SpringChange* c, double start, double rest, double length) {
  const double flown = rest / start - 1;
  const double stress = (length - rest) / start - c->hardening * flown;
  const double excess = fabs(stress) - c->yield_strain;
  if (!(excess > 0)) return rest;
  const double flow = copysign(c->share * excess / (1 + c->hardening), stress);
  return start * (1 + clamp(flown + flow, -c->most_strain, c->most_strain));
}

// Changes the springs of each particle. Both ends of a spring change equally.
kernel void change_springs(const int count, global const double* position,
                           global const uint* spring_begin, global const double* starts,
                           global const int* body_of, global const Body* bodies,
                           global const SpringChange* changes, global SpringEnd* springs,
                           global int* are_torn) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const SpringChange change = changes[bodies[body_of[i]].material];
  const double3 own = vector_at(position, i);
  for (uint s = spring_begin[i]; s < spring_begin[i + 1]; ++s) {
    const double start = starts[s];
    if (are_torn[s] || start == 0) continue;
    const double3 x = own - vector_at(position, springs[s].other);
    const double length = sqrt(product(x, x));
    if (length > change.greatest_stretch * start) {
      are_torn[s] = 1;
      springs[s].stiffness = 0;
      springs[s].damping = 0;
    } else if (change.flows) {
      springs[s].rest_length = flown_length(&change, start, springs[s].rest_length, length);
    }
  }
}
