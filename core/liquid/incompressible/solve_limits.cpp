#include "core/liquid/incompressible/solve_limits.h"

#include <algorithm>

#include "core/laws/vat_motion.h"

namespace vat {
namespace {

constexpr Real kGreatestOverMean = 36;  // ratio of maximum and mean, for densities
// Ratio of maximum and mean for changes of density, which the correction of positions removes.
constexpr Real kGreatestDivergence = 200;
// Bounds of loose tolerances. They keep the kinetic energy small that a step adds by removing
// excess density, and start each solve from pressures that are close to its own. A residual r of
// one particle adds about r h / dt to its velocity. Adaptive steps permit velocities of 0.25 h / dt
// (core/stepping/control/step_control_liquid.cpp), so pressures that no solve updates add at most
// 0.03 of the greatest velocity in each step. Otherwise the velocities grow while steps shorten.
constexpr Real kMaxGreatestDivergence = 0.05;  // residual of one particle
constexpr Real kMaxMeanDivergence = 0.003;     // mean residual
constexpr Real kStartMeanDivergence = 0.001;   // mean residual above which pressures are updated
constexpr Real kStartGreatestDivergence = 0.0075;  // the same for the residual of one particle
// Share of the divergence tolerance at which a solve ends. The residual of the last iteration is an
// estimate, and the residuals of steps add up to density errors.
constexpr Real kDivergenceShare = 0.9;
constexpr Real kDivergenceOfDensity = 0.25;  // mean divergence / density tolerance
constexpr Real kMaxRemoval = 0.0015;         // relative excess density that one step removes
constexpr Real kLeftAlone = 0.1;     // share of the density tolerance that the velocities leave
constexpr Real kClosing = 0.25;      // share of a gap that is closed in one step
constexpr Real kLinearShare = 0.25;  // share of the density tolerance for the solve of one round
// The same for the greatest excess if the mean is met, so that most rounds need one iteration.
constexpr Real kGreatestShare = 0.75;
// Ratios of the residuals after and before the first iteration and a later one: slightly above the
// medians in a dam break with a density tolerance of 0.0015 and a divergence tolerance of 0.001.
constexpr Real kFirstReduction = 0.55;
constexpr Real kLaterReduction = 0.75;

}  // namespace

DensityRoom density_room(const IncompressibleSolve& wanted) {
  return {kClosing, kLeftAlone * wanted.density_tolerance,
          std::min(wanted.density_tolerance, kMaxRemoval)};
}

SolveLimits velocity_limits(const IncompressibleSolve& wanted) {
  const Real bound = std::clamp(kDivergenceOfDensity * wanted.density_tolerance,
                                kStartMeanDivergence, kMaxMeanDivergence);
  const Real tolerance = kDivergenceShare * std::min(wanted.divergence_tolerance, bound);
  return {.mean = tolerance,
          .greatest = std::min(kGreatestDivergence * tolerance, kMaxGreatestDivergence),
          .most_iterations = wanted.most_iterations,
          .start_mean = std::min(tolerance, kStartMeanDivergence),
          .start_greatest = kStartGreatestDivergence,
          .first_reduction = kFirstReduction,
          .later_reduction = kLaterReduction};
}

SolveLimits place_limits(const IncompressibleSolve& wanted, bool mean_is_met) {
  const Real tolerance = kLinearShare * wanted.density_tolerance;
  const Real greatest_share = mean_is_met ? kGreatestShare : kLinearShare;
  // A round removes at most kMaxExpansion, which may be less than the limit of the greatest excess.
  // The round must make an iteration in this case, too.
  return {.mean = mean_is_met ? wanted.density_tolerance : tolerance,
          .greatest = kGreatestOverMean * greatest_share * wanted.density_tolerance,
          .most_iterations = wanted.most_iterations,
          .start_mean = 0,
          .start_greatest = 0,
          .first_reduction = kFirstReduction,
          .later_reduction = kLaterReduction};
}

bool is_solved(const IncompressibleSolve& wanted, const SolveReport& places) {
  return places.mean <= wanted.density_tolerance &&
         places.greatest <= kGreatestOverMean * wanted.density_tolerance;
}

Vec3 mean_wall_velocity(const Model& model, Real time, Real dt) {
  if (!model.scene.vat) return Vec3::Zero();
  const Vat& vat = *model.scene.vat;
  return (vat_motion(vat, time + dt).offset - vat_motion(vat, time).offset) / dt;
}

}  // namespace vat
