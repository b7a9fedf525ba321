#pragma once

namespace vat {

struct StepContext;

/// Stages of cohesive liquids. Surface tension and contact angles result from pairwise central
/// forces between particles, which are equal and opposite and derive from an energy.
///
/// Two particles of one liquid have the energy -A V_i V_j U(r), see CohesionKernel. Near particles
/// repel each other, and distant particles attract each other, so that the forces cause no pressure
/// within a liquid (A. M. Tartakovsky, A. Panchenko, J. Comput. Phys. 305 (2016) 1119). The support
/// radius of U is twice that of the density kernel. With a smaller radius, particles at a surface
/// would only become denser until the density is restored (S. Nugent, H. A. Posch, Phys. Rev. E 62
/// (2000) 4968). The pressure of the equation of state may be negative, so that the surface resists
/// tension. The minimum is -kTensileShare A/2 s^2, a fraction of the attraction of the far part.
///
/// The separation of a uniform liquid into two half spaces requires the energy A int z U per area,
/// integrated over a half space. The separation creates two surfaces, so that the energy per
/// surface area is A M_1 (kReach - kCore) h / 2, with M_1 = CohesionKernel::first_moment(). In
/// space, the energy is pi/8 int r^4 f for a force f between two particles (J. G. Kirkwood, F. P.
/// Buff, J. Chem. Phys. 17 (1949) 338). At rest, a surface is denser than a uniform liquid, so that
/// the forces across the surface are in equilibrium. Including the energy of the pressure, a plane
/// surface of a continuum at rest has kRelaxation times the energy of a uniform liquid. This factor
/// is equal within 3 % in space and in the plane, for all speeds of sound above that of capillary
/// waves.
///
/// Walls of the vat and the volumes of solid particles repel a liquid with the near part of U. They
/// attract the liquid with the far part times a share that determines the contact angle theta.
/// Walls are half spaces, so that their forces are integrals instead of sums, and allow slip.
/// Young's equation, cos theta = -sigma_wall / sigma, determines the energy sigma_wall per area of
/// a liquid at rest at a wall. For a uniform liquid, sigma_wall would be linear in the share. For a
/// continuum whose density is mirrored at the wall, the share is adhesion_share(), with an error of
/// 0.03 in cos theta.

/// Stage that adds the forces of liquid particles and walls on liquid particles.
void add_cohesion(StepContext& context);

/// Stage that adds the forces between liquid and solid particles, on both.
void add_adhesion(StepContext& context);

}  // namespace vat
