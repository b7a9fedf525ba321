#include "core/device/common/verlet_method.h"

#include "core/support/check.h"

namespace vat {

void VerletMethod::take_step(StepMoment moment, Real end, AdvanceReport& report) {
  const bool solves = must_solve(moment.drift);
  // Forces with a solve depend on the velocities before it; see evaluate_at_end().
  moment.prediction = model_->damping.any && !solves ? moment.opening : 0;
  evaluate(moment, end);
  report.count_evaluation(model_->particle_count);
  if (solves) report.iterations.damping += solve_damping(end, moment.opening);
}

void VerletMethod::take_fixed_steps(std::uint64_t first, std::uint32_t steps,
                                    AdvanceReport& report) {
  const Real dt = model_->scene.numerics.step;
  const auto time = [&](std::uint32_t s) { return static_cast<Real>(first + s) * dt; };
  StepMoment moment{0, 0, dt / 2, dt, 0};
  for (std::uint32_t s = 0; s < steps; ++s) {
    moment.time = time(s);
    take_step(moment, moment.time + dt, report);
    moment.closing = dt / 2;
  }
  moment.time = time(steps);
  finish(moment);
  report.count_steps(steps, dt, dt);
}

bool VerletMethod::take_steps(const EngineInput& input, std::uint32_t steps) {
  VAT_CHECK(steps > 0);
  const State& state = input.state;
  if (!input.continues) write(state);
  save();
  counters().clear();
  AdvanceReport report = input.report;
  if (!input.continues && !state.forces_current) {
    const Real now = static_cast<Real>(state.step_count) * model_->scene.numerics.step;
    evaluate({now, 0, 0, 0, 0}, now);
    report.count_evaluation(model_->particle_count);
  }
  take_fixed_steps(state.step_count, steps, report);
  const Counters counted = counters().read();
  if (counted.faults != 0) {
    restore();
    return false;
  }
  report.wall_stops += static_cast<std::uint64_t>(counted.stops);
  input.report = std::move(report);
  return true;
}

}  // namespace vat
