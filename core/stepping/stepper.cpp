#include "core/stepping/stepper.h"

#include <algorithm>
#include <cmath>

#include "core/contact/scratch.h"
#include "core/guard/enforce_walls.h"
#include "core/limits.h"
#include "core/liquid/pairs/scratch.h"
#include "core/solid/spring_changes.h"
#include "core/state/kick_drift.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr int kMaxHalvings = 3;

Index number_of(const ModelBody& body, Index particle) {
  const bool is_plain = !body.sample || body.sample->numbers.empty();
  return is_plain ? particle : body.sample->numbers[particle];
}

}  // namespace

void Stepper::take_local_step(const StepInput& input, const StepInterval& interval) {
  const Real dt = interval.length;
  local_.take_step(input.force_model, input.state, interval.start, dt, input.step_bounds,
                   input.guard_bounds);
  if (change_springs(input.model(), input.force_model.runner, input.state.now, dt)) {
    input.state.forces_current = false;
    local_.forget();
  }
  input.report.count_steps(1U << local_.finest(), std::ldexp(dt, -local_.finest()),
                           std::ldexp(dt, -local_.coarsest()));
}

void Stepper::undo_step(State& state) {
  state.now = step_start_;
  state.forces_current = false;
  local_.forget();
}

bool Stepper::enforce_walls_after(const StepInput& input, Real end) {
  const ForceModel& f = input.force_model;
  State& state = input.state;
  f.enter("enforce_walls");
  // The end of a nominal step must have the bits of the time at which views show the vat.
  const Real step = input.numerics().step;
  const Real nominal_end = static_cast<Real>(state.step_count + 1) * step;
  const Real least_part = std::ldexp(step, -kMaxStepLevel - kMaxHalvings);
  if (std::abs(end - nominal_end) < least_part / 2) end = nominal_end;
  const std::uint64_t stops = enforce_walls(f.model, input.guard_bounds, {end, state.step_count},
                                            step_start_, f.runner, state.now);
  if (stops == 0) return false;
  input.report.wall_stops += stops;
  state.forces_current = false;
  local_.forget();
  return true;
}

std::optional<Fault> Stepper::find_step_fault(const StepInput& input, Real dt) const {
  const ForceModel& f = input.force_model;
  const Configuration& now = input.state.now;
  f.enter("guard");
  if (f.work.of<LiquidScratch>().too_many_pairs) {
    return Fault{GuardEvent::Cause::too_many_pairs, f.model.body[0], 0};  // liquids come first
  }
  if (f.work.of<ContactForceScratch>().too_many_contacts) {
    return Fault{GuardEvent::Cause::too_many_pairs, 0, 0};
  }
  const Real finest = std::ldexp(dt, -local_.finest());
  const auto fault = find_fault(f.model, now, input.guard_bounds, finest, f.runner);
  if (fault || input.numerics().control != StepControl::local) return fault;
  return local_.find_fast(f.model, now, dt, input.guard_bounds);
}

std::optional<GuardEvent> Stepper::take_step_in(std::uint32_t parts, const StepInput& input,
                                                Real start, Real whole) {
  VAT_CHECK(whole > 0 && parts > 0);
  const Real dt = whole / parts;
  for (std::uint32_t part = 0; part < parts; ++part) {
    const StepInterval interval{start + part * dt, dt, start + (part + 1) * dt};
    const std::optional<Fault> fault = take_step(input, interval);
    if (!fault) continue;
    VAT_CHECK(fault->body < input.model().bodies.size());
    const ModelBody& body = input.model().bodies[fault->body];
    return GuardEvent{fault->cause, interval.end, body.id, number_of(body, fault->particle),
                      dt,           true};
  }
  return {};
}

bool Stepper::take_guarded_step(const StepInput& input, Real start, Real dt) {
  AdvanceReport& report = input.report;
  const std::size_t earlier_events = report.events.size();
  input.force_model.enter("keep_state");
  copy(input.state.now, input.force_model.runner, step_start_);
  for (int halvings = 0; halvings <= kMaxHalvings; ++halvings) {
    const auto event = take_step_in(1U << halvings, input, start, dt);
    if (!event) {
      // Local control chose the levels of the next step for a step of this part's length.
      if (halvings > 0 && input.numerics().control == StepControl::local) {
        input.state.forces_current = false;
      }
      return true;
    }
    report.add(*event);
    undo_step(input.state);
  }
  for (std::size_t e = std::min(earlier_events, report.events.size() - 1); e < report.events.size();
       ++e) {
    report.events[e].recovered = false;
  }
  return false;
}

Real Stepper::probe_start(const StepInput& input, Real start, Real dt) {
  ForceModel f = input.force_model;
  f.probe = &probe_;
  State& state = input.state;
  copy(state.now, f.runner, step_start_);
  state.forces_current = false;
  probe_.begin(state);
  f.evaluate(state.now, start, state.forces);
  f.enter("choose_step");
  const Forces forces = state.forces;
  if (f.model.damping.any) state.bound = find_bound(f, state.now);
  kick(f.model, f.runner, forces, state.now, dt / 2);
  drift(f.model, f.runner, state.now, dt);
  f.evaluate(state.now, start + dt, state.forces);
  f.enter("choose_step");
  state.now = step_start_;
  state.forces = forces;
  state.forces_current = integrator_of(input.numerics().integrator).keeps_forces();
  return probe_.observed_rate(f.model);
}

Real Stepper::find_allowed_step(const StepInput& input, Real start) {
  const ForceModel& f = input.force_model;
  State& state = input.state;
  f.enter("choose_step");
  const Numerics& numerics = input.numerics();
  if (numerics.control == StepControl::local) {
    return greatest_base_step(f, state, input.step_bounds, input.guard_bounds,
                              present_steps_.liquid_scratch);
  }
  // A step is at most twice as long as the last one.
  const Real last = state.history.step;
  const Real longest = last > 0 ? std::min(numerics.step, 2 * last) : numerics.step;
  find_present_steps(f, state, start, longest, input.step_bounds, input.guard_bounds,
                     present_steps_);
  const Real step = present_steps_.least();
  if (last == 0) {
    const Real probed = kProbeShare * std::min(step, numerics.step);
    state.history.observed_rate = probe_start(input, start, probed);
  }
  return limit_by_rate(f.model, step, state.history.observed_rate);
}

bool Stepper::take_varied_step(const StepInput& input) {
  State& state = input.state;
  const Real nominal = input.numerics().step;
  const bool is_local = input.numerics().control == StepControl::local;
  // A step with one evaluation does not show the rate.
  const Integrator& integrator = integrator_of(input.numerics().integrator);
  const bool is_probed =
      !is_local && (integrator.take_step != nullptr || integrator.keeps_forces());
  ForceModel probed = input.force_model;
  if (is_probed) probed.probe = &probe_;
  const StepInput varied{probed, state, input.guard_bounds, input.step_bounds, input.report};
  for (Real left = nominal; left > 0;) {
    const Real start = input.time() + (nominal - left);
    const Real last = state.history.step;
    const std::uint32_t count =
        choose_step_count(find_allowed_step(varied, start), left, nominal, state.history);
    const Real dt = state.history.step;
    const bool is_same = std::abs(dt - last) <= 1e-9 * dt;  // up to rounding
    if (is_local && !is_same) state.forces_current = false;
    if (is_probed) probe_.begin(state);
    if (!take_guarded_step(varied, start, dt)) return false;
    if (!is_local) {
      state.history.observed_rate = is_probed ? probe_.observed_rate(input.model()) : 0;
    }
    ++state.history.held;
    left = count == 1 ? 0 : left - dt;
  }
  return true;
}

bool Stepper::take_nominal_step(const StepInput& input) {
  if (input.numerics().control != StepControl::fixed) return take_varied_step(input);
  return take_guarded_step(input, input.time(), input.numerics().step);
}

}  // namespace vat
