#include "core/liquid/incompressible/volume_solve.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <cstdint>

#include "core/guard/enforce_walls.h"
#include "core/liquid/gas/liquid.h"
#include "core/liquid/incompressible/pressure_response.h"
#include "core/liquid/incompressible/solve_limits.h"
#include "core/liquid/pairs/liquid_pairs.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/liquid/tait/weakly_compressible.h"
#include "core/rigid/rigid.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kAlone = 1;  // the diagonal of a particle without neighbours

/// Solves over the slots of the liquid, for pressures times dt^2.
class VolumeSolve {
 public:
  /// The workspace must have cells, pairs and densities of the present positions.
  VolumeSolve(const ForceModel& f, Configuration& now, Real dt, bool solids_move)
      : f_(f),
        now_(now),
        dt_(dt),
        s_(f.work.of<VolumeScratch>()),
        response_(f, now, s_.response, solids_move),
        problem_(s_.problem),
        order_(f.work.of<LiquidScratch>().liquid.grid.order()) {
    set_up();
  }

  SolveReport project_velocities(const Vec3& wall_velocity);
  /// Moves the particles so that their density decreases to the rest density. `mean_is_met`: the
  /// mean density is within its tolerance, and only that of some particles is not. Returns the
  /// number of iterations.
  int shift_places(bool mean_is_met);

  // Required by Complementarity.
  Real act(std::span<const Real> change) {
    response_.accelerate(change);
    return dt_ * dt_ * response_.energy();
  }
  void find_product(std::span<Real> product) {
    response_.compress(product, problem_.scale, -dt_ * dt_);
  }
  void add(Real share) { response_.add(share); }

 private:
  template <class F>
  void each_slot(F&& f) {
    for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) f(s);
    });
  }
  void set_up();
  /// The total accelerations of the response are then those of the change of x.
  SolveReport solve(const SolveLimits& limits);

  const ForceModel& f_;
  Configuration& now_;
  const Real dt_;
  VolumeScratch& s_;
  PressureResponse response_;
  Complementarity& problem_;
  const std::span<const Index> order_;
};

void VolumeSolve::set_up() {
  VAT_CHECK(dt_ > 0 && order_.size() == f_.model.liquid_count);
  VAT_CHECK(f_.work.of<LiquidScratch>().density.size() >= order_.size());
  problem_.resize(order_.size());
  s_.relative_density.resize(order_.size());
  response_.find_diagonal(problem_.diagonal);
  const std::span<const Real> density = f_.work.of<LiquidScratch>().density;
  each_slot([&](std::size_t s) {
    const Index i = order_[s];
    s_.relative_density[s] = density[i] / liquid_of(f_.model, i).rest_density;
    problem_.scale[s] = f_.model.rest_volume[i];
    Real& diagonal = problem_.diagonal[s];
    diagonal = diagonal > 0 ? dt_ * dt_ * diagonal : kAlone;
  });
}

SolveReport VolumeSolve::project_velocities(const Vec3& wall_velocity) {
  const IncompressibleSolve& wanted = f_.model.scene.incompressible;
  response_.see_velocities(wall_velocity);
  VAT_CHECK(now_.pressure.size() == order_.size());
  response_.compress(problem_.excess);
  const DensityRoom bounds = density_room(wanted);
  each_slot([&](std::size_t s) {
    const Real density = s_.relative_density[s];
    const Real excess = density - 1 - bounds.left_alone;
    const Real room =
        density < 1 ? bounds.closing * (1 - density) : -std::clamp(excess, Real{0}, bounds.removal);
    problem_.excess[s] = problem_.scale[s] * (dt_ * problem_.excess[s] - room);
    const bool is_alone = problem_.diagonal[s] == kAlone;
    problem_.x[s] = is_alone ? 0 : now_.pressure[order_[s]] / (density * density);
    if (is_alone) problem_.excess[s] = std::min(problem_.excess[s], Real{0});
  });
  const SolveReport report = solve(velocity_limits(wanted));
  if (report.iterations == 0) return report;
  each_slot([&](std::size_t s) {
    now_.pressure[order_[s]] = problem_.x[s] * s_.relative_density[s] * s_.relative_density[s];
  });
  response_.kick(dt_);
  return report;
}

int VolumeSolve::shift_places(bool mean_is_met) {
  each_slot([&](std::size_t s) {
    problem_.excess[s] = problem_.scale[s] * std::min(s_.relative_density[s] - 1, kMaxExpansion);
    problem_.x[s] = 0;
  });
  const SolveReport report = solve(place_limits(f_.model.scene.incompressible, mean_is_met));
  if (report.iterations > 0) response_.shift(dt_ * dt_);
  return report.iterations;
}

SolveReport VolumeSolve::solve(const SolveLimits& limits) {
  return problem_.solve(limits, f_.runner, *this);
}

/// Finds cells, pairs and densities after a change of positions.
void find_density(StepContext& c) {
  sort_liquid(c);
  if (has_solids(c.model)) sort_solids_in_liquid(c);
  find_pair_clusters(c);
  compute_tait_density(c);
}

/// Measures the densities above the rest density.
void measure_excess(const StepContext& c, SolveReport& report) {
  const std::span<const Real> density = c.work.of<LiquidScratch>().density;
  std::vector<SolveReport>& parts = c.work.of<VolumeScratch>().excess;
  parts.resize(block_count(c.model.liquid_count));
  for_blocks(c.runner, c.model.liquid_count, [&](std::size_t begin, std::size_t end) {
    SolveReport part;
    for (std::size_t i = begin; i < end; ++i) {
      const Real excess = density[i] / liquid_of(c.model, i).rest_density - 1;
      // The guard detects a NaN.
      part.mean += std::max(Real{0}, excess);
      part.greatest = std::max(part.greatest, excess);
    }
    parts[begin / kBlockSize] = part;
  });
  report.mean = 0;
  report.greatest = 0;
  for (const SolveReport& part : parts) {
    report.mean += part.mean / c.model.liquid_count;
    report.greatest = std::max(report.greatest, part.greatest);
  }
}

}  // namespace

void recall_pressure(StepContext& c) {
  VAT_CHECK(c.configuration.pressure.size() == c.model.liquid_count);
  c.work.of<LiquidScratch>().pressure = c.configuration.pressure;
}

void project_velocities(const ForceModel& f, State& state, Real time, Real dt) {
  VolumeSolve solve(f, state.now, dt, true);
  SolveReport& report = state.volume.velocities;
  report = solve.project_velocities(mean_wall_velocity(f.model, time, dt));
  if (f.report == nullptr) return;
  f.report->iterations.velocities += static_cast<std::uint64_t>(report.iterations);
}

void correct_density(const ForceModel& f, State& state, Real time) {
  f.enter("correct_density");
  Configuration& now = state.now;
  Forces unused;
  StepContext c{f.model, f.controls, time, f.step, now, unused, f.work, f.runner};
  const IncompressibleSolve& wanted = f.model.scene.incompressible;
  if (!f.model.rigid_bodies.empty()) pose_rigid_bodies(c);
  SolveReport& report = state.volume.places;
  report = {};
  for (int round = 0;; ++round) {
    hold_liquid_inside(f, time, now);
    find_density(c);
    measure_excess(c, report);
    const bool is_last = is_solved(wanted, report) || round == kMaxCorrections;
    if (is_last || f.work.of<LiquidScratch>().too_many_pairs) return;
    constexpr Real kUnit = 1;  // shifts take no time
    const bool mean_is_met = report.mean <= wanted.density_tolerance;
    const int iterations = VolumeSolve(f, now, kUnit, false).shift_places(mean_is_met);
    report.iterations += iterations;
    if (f.report == nullptr) continue;
    f.report->iterations.places += static_cast<std::uint64_t>(iterations);
  }
}

}  // namespace vat
