// Laws of contacts. Layers and restitution are further terms, which the programs of other scenes do not
// have.

#ifdef VAT_CONTACT_TERMS
#define HAS_TERMS 1
#else
#define HAS_TERMS 0
#endif

typedef struct {
  double stiffness;
  double damping;
  double threshold;
  double friction;
  double layer;
  double damping_ratio;
} ContactLaw;

// The mobility of a particle in simultaneous contacts, see ContactMobility. `shared` is its change of
// velocity by unit impulses of all contacts of its body. The mobility by an impulse on it along n is
// `inverse_mass` plus the squares of the products of `turns` and n, which represent the rotation of a
// rigid body about its principal axes. In this form, small mobilities have small rounding errors.
typedef struct {
  double inverse_mass;
  double shared[3];
  double turns[9];
} Mobility;

// The distance below which a contact acts, if the particles touch at `touching`.
INLINE double threshold_of(ContactLaw law, double touching) {
  const double rest = law.threshold > 0 ? law.threshold : touching;
  return HAS_TERMS ? rest * (1 + law.layer) : rest;
}

// The width of a layer that begins at the distance `threshold`.
INLINE double width_of_layer(ContactLaw law, double threshold) {
  return threshold * law.layer / (1 + law.layer);
}

// See core/laws/lennard_jones.h.
INLINE double layer_push(ContactLaw law, double threshold, double r) {
  const double width = width_of_layer(law, threshold);
  const double u = threshold - r;
  return law.stiffness * u * u * (u * u - width * width) / (2 * width * width * width);
}

INLINE double greatest_layer_slope(ContactLaw law, double threshold, double r) {
  const double width = width_of_layer(law, threshold);
  const double u = threshold - r;
  return fmax(law.stiffness,
              law.stiffness * u * (2 * u * u - width * width) / (width * width * width));
}

INLINE double damping_for(double damping_ratio, double stiffness, double mobility) {
  return mobility > 0 ? 2 * damping_ratio * sqrt(stiffness / mobility) : 0;
}

// The speed of a particle along the unit vector n per unit impulse of all contacts of its body.
INLINE double mobility_along(global const Mobility* mobility, double3 n) {
  const Mobility m = *mobility;
  double own = m.inverse_mass;
  for (int k = 0; k < 9; k += 3) {
    const double turn = m.turns[k] * n.x + m.turns[k + 1] * n.y + m.turns[k + 2] * n.z;
    own += turn * turn;
  }
  return fmax(m.shared[0] * n.x + m.shared[1] * n.y + m.shared[2] * n.z, own);
}
