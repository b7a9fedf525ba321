#pragma once

#include "core/scene/scene.h"

namespace vat::validation {

/// Returns the density of a cubic (square) lattice, relative to the rest density: the sum of poly6
/// over the lattice. Each particle's mass is density times spacing^dimensions.
Real lattice_density(int dimensions, Real support_over_spacing);

/// Sets the mass of the scene's first body, a sampled liquid, so that its lattice has the rest
/// density. Otherwise the gas law converts the error of the sum into a pressure. The weakly
/// compressible liquid scales its kernel instead.
void set_rest_mass(Scene& scene);

/// Sets the lattice spacing of the first body, a sampled liquid, and its support radius in
/// proportion. Sets its mass as set_rest_mass() does.
void set_spacing(Scene& scene, Real spacing);

/// Makes the walls as stiff for a particle of the first body as a layer of the liquid, with a tenth
/// of critical damping. Undamped walls would keep the liquid in motion.
void set_walls_like_liquid(Scene& scene);

/// Returns the kinematic viscosity alpha c H / (2 (d + 2)) [m^2/s] of Monaghan's artificial
/// viscosity `alpha`. The support radius H is its length.
Real artificial_viscosity(const Scene& scene, Real alpha);

/// Returns the height of a layer of weakly compressible liquid at rest, under the weight of `above`
/// [m] of the liquid. `thickness` is its uncompressed height: dz/dz_0 = rho_0/rho = (1 + 7 g depth
/// / c^2)^(-1/7).
Real pressed_height(Real thickness, Real above, Real c2);

/// Returns the longest step that divides `interval` and in which sound travels at most a fifth of
/// the support radius. In a weakly compressible liquid, the limit is two fifths. Half of the stable
/// step is 0.48 or 0.43 of the support radius.
Real acoustic_step(const Scene& scene, Real interval);

}  // namespace vat::validation
