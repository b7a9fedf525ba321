#pragma once

#include "core/laws/surface_tension.h"

namespace vat {

struct StepContext;

/// Stages of cohesive liquids: surface tension and contact angles by central forces between
/// particles, equal and opposite, that derive from an energy.
///
/// Two particles of one liquid have the energy -A V_i V_j U(r), see CohesionKernel. Near particles
/// repel and distant ones attract each other, so that these forces cause no pressure within a
/// liquid (A. M. Tartakovsky, A. Panchenko, J. Comput. Phys. 305 (2016) 1119). They reach twice as
/// far as the density kernel. With a shorter reach, particles at a surface only crowd until the
/// density is restored (S. Nugent, H. A. Posch, Phys. Rev. E 62 (2000) 4968). The equation of state
/// may be negative, which holds the surface together: down to -kTensileShare A/2 s^2, a share of
/// the attraction of the far part.
///
/// Separating two half spaces of a uniform liquid takes the energy A int z U over a half space per
/// area, which is twice that of a surface: A M_1 (kReach - kCore) h / 2, M_1 = first_moment(). In
/// space this is pi/8 int r^4 f for a force f between two particles (J. G. Kirkwood, F. P. Buff, J.
/// Chem. Phys. 17 (1949) 338). A surface at rest is denser than a uniform liquid, until the forces
/// across it are in equilibrium. With the energy of the pressure, a plane surface of a continuum at
/// rest has kRelaxation times as much. This factor is equal within 3 % in space and in the plane,
/// for all speeds of sound that exceed that of capillary waves.
///
/// Walls of the vat, and solids by the volumes of their particles, repel a liquid as it repels
/// itself, and attract it with a share of its far part, which determines the contact angle theta.
/// Walls are half spaces, which need no sum and let the liquid slip. Young's equation, cos theta =
/// -sigma_wall / sigma, determines the energy sigma_wall of a liquid at rest at a wall. For a
/// uniform liquid it would be linear in the share. For a continuum whose density is mirrored at the
/// wall, the share is adhesion_share(), with an error of 0.03 in cos theta.

/// Adds the forces of liquid particles and walls on liquid particles.
void add_cohesion(StepContext& context);

/// Adds the forces between liquid and solid particles, on both.
void add_adhesion(StepContext& context);

}  // namespace vat
