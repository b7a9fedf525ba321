#pragma once

#include "core/laws/cohesion.h"

namespace vat {

struct StepContext;

/// Stages of liquids whose particles attract each other: surface tension and contact angles by
/// forces along the line between two particles, equal and opposite, that derive from an energy.
///
/// Two particles of one liquid have the energy -A V_i V_j U(r), see CohesionKernel: near ones repel
/// and far ones attract, so that such forces press and pull nothing within a liquid (A. M.
/// Tartakovsky, A. Panchenko, J. Comput. Phys. 305 (2016) 1119), and reach twice as far as its
/// density, without which particles at a surface only crowd until the density is made up for (S.
/// Nugent, H. A. Posch, Phys. Rev. E 62 (2000) 4968). In place of forces that hold a surface
/// together, the equation of state may pull: down to -kTensileShare A/2 s^2, a share of the far
/// part's own pull.
///
/// To part two half spaces of a uniform liquid takes A times int z U over a half space an area,
/// which is twice what a surface has: A M_1 (kReach - kCore) h / 2, M_1 = first_moment(). In space
/// that is the pi/8 int r^4 f of a force f between two (J. G. Kirkwood, F. P. Buff, J. Chem. Phys.
/// 17 (1949) 338). A surface at rest is not that of a uniform liquid: particles there sit denser,
/// until forces across it balance. With the pressure's energy a plane surface at rest, of liquid as
/// a continuum, has kRelaxation times as much, the same to 3 % in space and in the plane and for
/// any sound that is fast against capillary waves.
///
/// Walls of the vat, and solids by their particles' volumes, repel a liquid as it repels itself and
/// attract it with a share of its own far part, which tells the contact angle theta: walls as a
/// half space, which needs no sum and lets a liquid slip along it. Young's equation, cos theta =
/// -sigma_wall / sigma, wants the energy sigma_wall that a liquid at rest has at a wall; of uniform
/// liquid it would be linear in the share. As a continuum whose density is mirrored at the wall it
/// has that of adhesion_share(), to 0.03 in cos theta.

/// The forces of liquid particles and walls on liquid particles.
void add_cohesion(StepContext& context);

/// Those between liquid particles and solid ones, on both.
void add_adhesion(StepContext& context);

}  // namespace vat
