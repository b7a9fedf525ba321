#pragma once

#include "core/diagnostics.h"
#include "core/liquid/incompressible/complementarity.h"
#include "core/model/model.h"

/// Bounds and limits of the solves in volume_solve.h, for all implementations of these solves.
namespace vat {

/// Maximum number of rounds of Newton's method for positions.
inline constexpr int kMaxCorrections = 12;
/// Maximum relative excess density that one round removes; linear theory is inaccurate beyond it.
inline constexpr Real kMaxExpansion = 0.05;

/// Bounds of the relative density change that the solve for velocities permits or requires.
struct DensityRoom {
  Real closing;     ///< share of a gap that is closed in one step
  Real left_alone;  ///< excess density that remains
  Real removal;     ///< maximum excess density that one step removes
};
DensityRoom density_room(const IncompressibleSolve& wanted);

/// Returns the limits of the solve for velocities. A divergence far above the density tolerance
/// would cost more iterations for positions than it saves for velocities.
SolveLimits velocity_limits(const IncompressibleSolve& wanted);

/// Returns the limits of the solve for positions of one round. `mean_is_met`: the mean density is
/// within its tolerance, and only that of some particles is not.
SolveLimits place_limits(const IncompressibleSolve& wanted, bool mean_is_met);

/// Returns whether the mean and the greatest excess density are within their tolerances.
bool is_solved(const IncompressibleSolve& wanted, const SolveReport& places);

/// Returns the mean velocity of the walls in a step of `dt` [s] from `time` [s] [m/s].
Vec3 mean_wall_velocity(const Model& model, Real time, Real dt);

}  // namespace vat
