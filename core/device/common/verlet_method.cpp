#include "core/device/common/verlet_method.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {
namespace {

/// Returns the first step after `step` at which a body is released, and at most `end`.
std::uint64_t next_release(const Model& model, std::uint64_t step, std::uint64_t end) {
  for (const RigidModel& rigid : model.rigid_bodies) {
    if (rigid.free_from > step) end = std::min(end, rigid.free_from);
  }
  return end;
}

}  // namespace

bool releases_body(const Model& model, std::uint64_t step) {
  return step > 0 && std::ranges::any_of(model.rigid_bodies, [&](const RigidModel& rigid) {
           return rigid.free_from == step;
         });
}

void VerletMethod::take_step(StepMoment moment, Real end, AdvanceReport& report) {
  const bool solves = must_solve(moment.drift);
  // Forces with a solve depend on the velocities before it; see evaluate_at_end().
  moment.prediction = model_->damping.any && !solves ? moment.opening : 0;
  evaluate(moment, end);
  report.count_evaluation(model_->particle_count);
  if (solves) report.iterations.damping += solve_damping(end, moment.opening);
}

void VerletMethod::evaluate_at_start(Real time, AdvanceReport& report) {
  evaluate({time, 0, 0, 0, 0}, time);
  report.count_evaluation(model_->particle_count);
}

bool VerletMethod::take_nominal_steps(const NominalSteps& steps, AdvanceReport& report) {
  const Real dt = steps.step;
  if (!steps.has_forces) evaluate_at_start(steps.time(0), report);
  StepMoment moment{0, 0, dt / 2, dt, 0};
  for (std::uint32_t s = 0; s < steps.count; ++s) {
    moment.time = steps.time(s);
    take_step(moment, moment.time + dt, report);
    wrap_liquid();
    moment.closing = dt / 2;
  }
  moment.time = steps.time(steps.count);
  finish(moment);
  report.count_steps(steps.count, dt, dt);
  return true;
}

bool VerletMethod::take_steps(const EngineInput& input, std::uint32_t steps) {
  VAT_CHECK(steps > 0);
  const State& state = input.state;
  if (!input.continues) write(state);
  save();
  counters().clear();
  AdvanceReport report = input.report;
  NominalSteps part{state.step_count, 0, model_->scene.numerics.step,
                    input.continues || state.forces_current};
  const std::uint64_t end = state.step_count + steps;
  bool is_valid = true;
  for (std::uint64_t step = state.step_count; step < end && is_valid; step += part.count) {
    part.first = step;
    part.count = static_cast<std::uint32_t>(next_release(*model_, step, end) - step);
    if (releases_body(*model_, step)) {
      release(step);
      part.has_forces = false;
    }
    is_valid = take_nominal_steps(part, report);
    part.has_forces = true;
  }
  const Counters counted = counters().read();
  if (!is_valid || counted.faults != 0) {
    restore();
    return false;
  }
  count_work(report);
  report.wall_stops += static_cast<std::uint64_t>(counted.stops);
  input.report = std::move(report);
  return true;
}

}  // namespace vat
