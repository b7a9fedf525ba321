#pragma once

#include "core/scene/scene.h"

namespace vat::validation {

/// Density of particles of density times spacing^dimensions on a cubic (square) lattice, over the
/// rest density: the sum of poly6 over the lattice.
Real lattice_density(int dimensions, Real support_over_spacing);

/// Gives the first body of the scene, a sampled liquid, the mass with which its lattice has the
/// rest density. Without it the gas law takes the error of the sum for a pressure; the weakly
/// compressible liquid scales its kernel instead.
void set_rest_mass(Scene& scene);

/// Sets the lattice spacing of the first body, a sampled liquid, with the support radius in
/// proportion, and its mass as above.
void set_spacing(Scene& scene, Real spacing);

/// Makes the walls as stiff to a particle of the first body as a layer of the liquid is, with a
/// tenth of critical damping: undamped walls keep the liquid at the boil.
void set_walls_like_liquid(Scene& scene);

/// Kinematic viscosity alpha c H / (2 (d + 2)) that the artificial viscosity `alpha` of Monaghan's
/// form stands for, with the support radius H in the place of its length [m^2/s].
Real artificial_viscosity(const Scene& scene, Real alpha);

/// Height of a layer of weakly compressible liquid at rest that is that thick without compression,
/// under the weight of `above` more of it [m]: dz/dz_0 = rho_0/rho = (1 + 7 g depth / c^2)^(-1/7).
Real pressed_height(Real thickness, Real above, Real c2);

/// The longest step, a whole part of `interval`, in which sound goes a fifth of the support radius,
/// or two fifths in a weakly compressible liquid: half of what is stable is 0.48 or 0.43 of it.
Real acoustic_step(const Scene& scene, Real interval);

}  // namespace vat::validation
