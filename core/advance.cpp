// The stepping of Simulation, under the guard.

#include <algorithm>

#include "core/limits.h"
#include "core/scene/error_model.h"
#include "core/simulation.h"
#include "core/simulation_impl.h"

namespace vat {
namespace {

constexpr int kMaxHalvings = 3;

}  // namespace

std::optional<GuardEvent> Simulation::Impl::take_step_in(std::uint32_t pieces,
                                                         const ForceModel& force_model, Real start,
                                                         Real whole, AdvanceReport& report) {
  const Real dt = whole / pieces;
  for (std::uint32_t piece = 0; piece < pieces; ++piece) {
    take_step(model->scene.numerics.integrator, force_model, state, start + piece * dt, dt,
              scratch);
    report.count_step(dt);
    auto fault = find_fault(*model, state.now, bounds, dt);
    if (work.too_many_pairs) {  // of liquids, whose particles come first
      fault = Fault{GuardEvent::Cause::too_many_pairs, model->body[0], 0};
    }
    if (fault) {
      return GuardEvent{fault->cause,
                        start + (piece + 1) * dt,
                        model->bodies[fault->body].id,
                        fault->particle,
                        dt,
                        true};
    }
  }
  return {};
}

bool Simulation::Impl::take_guarded_step(const ForceModel& force_model, Real start, Real dt,
                                         AdvanceReport& report) {
  const std::size_t earlier_events = report.events.size();
  step_start = state.now;
  for (int halvings = 0; halvings <= kMaxHalvings; ++halvings) {
    const auto event = take_step_in(1U << halvings, force_model, start, dt, report);
    if (!event) return true;
    report.add(*event);
    state.now = step_start;
    state.forces_current = false;
  }
  for (std::size_t e = std::min(earlier_events, report.events.size() - 1); e < report.events.size();
       ++e) {
    report.events[e].recovered = false;
  }
  return false;
}

std::uint32_t Simulation::Impl::wanted_level(const ForceModel& force_model, Real start) {
  const Numerics& numerics = model->scene.numerics;
  find_present_steps(force_model, state, start, numerics.step, step_bounds, bounds, present_steps);
  Real step = present_steps.least();
  if (state.history.observed_rate > 0) {
    step = std::min(step, resolving_phase(numerics.integrator, numerics.tolerance) /
                              state.history.observed_rate);
  }
  return level_of(step, numerics.step);
}

bool Simulation::Impl::take_adaptive_step(ForceModel& force_model, AdvanceReport& report) {
  constexpr std::uint32_t kParts = 1U << kMaxStepLevel;
  const Real part = step_size() / kParts;
  force_model.probe = &probe;
  for (std::uint32_t position = 0; position < kParts;) {
    const Real start = time() + position * part;
    choose_level(wanted_level(force_model, start), position, state.history);
    const std::uint32_t parts = kParts >> state.history.level;
    probe.begin(state);
    if (!take_guarded_step(force_model, start, parts * part, report)) return false;
    state.history.observed_rate = probe.observed_rate(*model);
    ++state.history.held;
    position += parts;
  }
  return true;
}

bool Simulation::Impl::take_guarded_steps(std::uint32_t steps, AdvanceReport& report) {
  ForceModel force_model{*model, controls, work, runner, observer};
  force_model.report = &report;
  const bool is_fixed = model->scene.numerics.control == StepControl::fixed;
  for (std::uint32_t s = 0; s < steps; ++s) {
    force_model.step = state.step_count;
    const bool is_taken = is_fixed ? take_guarded_step(force_model, time(), step_size(), report)
                                   : take_adaptive_step(force_model, report);
    if (!is_taken) return false;
    ++state.step_count;
    for (const AppliedForce& applied : controls.applied_forces) {
      // The forces that velocity Verlet keeps for the next step still have this one in them.
      if (applied.end_step == state.step_count) state.forces_current = false;
    }
    for (const RigidModel& rigid : model->rigid_bodies) {
      // Those forces do not act on a body that was held.
      if (rigid.free_from == state.step_count) state.forces_current = false;
    }
  }
  return true;
}

AdvanceReport Simulation::advance(std::uint32_t steps) {
  Impl& impl = *impl_;
  AdvanceReport report;
  impl.call_start = impl.state;
  try {
    report.failed = !impl.take_guarded_steps(steps, report);
  } catch (...) {  // out of memory
    impl.state = impl.call_start;
    throw;
  }
  if (report.failed) impl.state = impl.call_start;
  std::erase_if(impl.controls.applied_forces, [&](const AppliedForce& applied) {
    return applied.end_step <= impl.state.step_count;
  });
  impl.pose_rigid_particles();
  return report;
}

void AdvanceReport::count_step(Real step) {
  least_step = steps == 0 ? step : std::min(least_step, step);
  greatest_step = std::max(greatest_step, step);
  ++steps;
}

void AdvanceReport::add(const GuardEvent& event) {
  ++undone_steps;
  if (events.size() < kMaxEvents) {
    events.push_back(event);
  } else {
    events.back() = event;
  }
}

}  // namespace vat
