#include "core/incompressible/volume_solve.h"

#include <algorithm>

#include "core/forces/liquid_pairs.h"
#include "core/forces/vat_motion.h"
#include "core/forces/weakly_compressible_pairs.h"
#include "core/incompressible/pressure_response.h"

namespace vat {
namespace {

constexpr Real kGreatestOverMean = 20;  // of residuals
constexpr Real kClosing = 0.5;          // of what is missing at rest density, in a step
constexpr Real kMostExpansion = 0.02;   // by shifts, in a step: theirs is linear theory
constexpr Real kAlone = 1;              // the diagonal of a particle with nothing around it

/// Of the vat's walls over the step.
Vec3 wall_velocity(const Model& model, Real time, Real dt) {
  if (!model.scene.vat) return Vec3::Zero();
  const Vat& vat = *model.scene.vat;
  return (vat_motion(vat, time + dt).offset - vat_motion(vat, time).offset) / dt;
}

/// One step's solves, over liquid slots.
class VolumeSolve {
 public:
  VolumeSolve(const ForceModel& f, Configuration& now, Real dt, const Vec3& walls,
              VolumeScratch& scratch)
      : f_(f),
        now_(now),
        dt_(dt),
        walls_(walls),
        s_(scratch),
        problem_(scratch.problem),
        order_(f.work.liquid.grid.order()) {}

  void set_up();
  SolveReport project_velocities();
  SolveReport correct_places();

 private:
  template <class F>
  void each_slot(F&& f) {
    for_blocks(f_.runner, order_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) f(s);
    });
  }
  SolveReport solve(PressureResponse& response, Real mean);
  void apply_impulses(PressureResponse& response);

  const ForceModel& f_;
  Configuration& now_;
  const Real dt_;
  const Vec3 walls_;
  VolumeScratch& s_;
  Complementarity& problem_;
  const std::span<const Index> order_;
};

void VolumeSolve::set_up() {
  problem_.resize(order_.size());
  s_.relative_density.resize(order_.size());
  s_.start.resize(order_.size());
  PressureResponse(f_, now_, s_.pairs, s_.response, true).find_diagonal(problem_.diagonal);
  each_slot([&](std::size_t s) {
    const Index i = order_[s];
    s_.relative_density[s] = f_.work.density[i] / liquid_of(f_.model, i).rest_density;
    problem_.scale[s] = f_.model.rest_volume[i];
    Real& diagonal = problem_.diagonal[s];
    diagonal = diagonal > 0 ? dt_ * dt_ * diagonal : kAlone;
  });
}

SolveReport VolumeSolve::project_velocities() {
  PressureResponse response(f_, now_, s_.pairs, s_.response, true);
  response.see_velocities(walls_);
  response.compress(problem_.excess);
  each_slot([&](std::size_t s) {
    const Real density = s_.relative_density[s];
    const Real room = kClosing * std::max(Real{0}, 1 - density);
    problem_.excess[s] = problem_.scale[s] * (dt_ * problem_.excess[s] - room);
    const bool is_alone = problem_.diagonal[s] == kAlone;
    problem_.x[s] = is_alone ? 0 : now_.pressure[order_[s]] / (density * density);
    if (is_alone) problem_.excess[s] = std::min(problem_.excess[s], Real{0});
    s_.start[s] = problem_.x[s];
  });
  const SolveReport report = solve(response, f_.model.scene.incompressible.divergence_tolerance);
  if (report.iterations > 0) apply_impulses(response);
  return report;
}

void VolumeSolve::apply_impulses(PressureResponse& response) {
  each_slot([&](std::size_t s) {
    const Real density = s_.relative_density[s];
    now_.pressure[order_[s]] = problem_.x[s] * density * density;
    problem_.x[s] -= s_.start[s];
  });
  response.accelerate(problem_.x);
  response.kick(dt_);
}

SolveReport VolumeSolve::correct_places() {
  PressureResponse response(f_, now_, s_.pairs, s_.response, false);
  const bool solids = has_solids(f_.model);
  if (solids) response.see_velocities(walls_);
  each_slot([&](std::size_t s) {
    const Real density = s_.relative_density[s];
    Real excess = density > 1 ? density - 1 : (1 - kClosing) * (density - 1);
    if (solids) excess -= dt_ * response.compression_by_solids(s);
    excess += problem_.excess[s] / problem_.scale[s];
    problem_.excess[s] = problem_.scale[s] * std::min(excess, kMostExpansion);
    problem_.x[s] = 0;
  });
  const SolveReport report = solve(response, f_.model.scene.incompressible.density_tolerance);
  if (report.iterations == 0) return report;
  response.accelerate(problem_.x);
  response.shift(dt_ * dt_);
  return report;
}

SolveReport VolumeSolve::solve(PressureResponse& response, Real mean) {
  const SolveLimits limits{mean, kGreatestOverMean * mean,
                           f_.model.scene.incompressible.most_iterations};
  return problem_.solve(limits, f_.runner, [&](std::span<const Real> d, std::span<Real> product) {
    response.accelerate(d);
    response.compress(product);
    each_slot([&](std::size_t s) { product[s] *= -dt_ * dt_ * problem_.scale[s]; });
  });
}

}  // namespace

void recall_pressure(StepContext& c) {
  c.work.pressure = c.configuration.pressure;
}

VolumeReport keep_volume(const ForceModel& f, Configuration& now, Real time, Real dt,
                         VolumeScratch& scratch) {
  Forces unused;
  scratch.pairs.build({f.model, f.controls, time, f.step, now, unused, f.work, f.runner});
  VolumeSolve solve(f, now, dt, wall_velocity(f.model, time, dt), scratch);
  solve.set_up();
  VolumeReport report;
  report.velocities = solve.project_velocities();
  report.places = solve.correct_places();
  return report;
}

}  // namespace vat
