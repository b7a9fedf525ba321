// The stepping of Simulation, under the guard.

#include <algorithm>

#include "core/simulation.h"
#include "core/simulation_impl.h"

namespace vat {
namespace {

constexpr int kMaxHalvings = 3;

}  // namespace

std::optional<GuardEvent> Simulation::Impl::take_step_in(std::uint32_t pieces,
                                                         const ForceModel& force_model,
                                                         AdvanceReport& report) {
  const Real start = time();
  const Real dt = step_size() / pieces;
  for (std::uint32_t piece = 0; piece < pieces; ++piece) {
    take_step(model->scene.numerics.integrator, force_model, state, start + piece * dt, dt,
              scratch);
    ++report.steps;
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

bool Simulation::Impl::take_guarded_step(const ForceModel& force_model, AdvanceReport& report) {
  const std::size_t earlier_events = report.events.size();
  step_start = state.now;
  for (int halvings = 0; halvings <= kMaxHalvings; ++halvings) {
    const auto event = take_step_in(1U << halvings, force_model, report);
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

bool Simulation::Impl::take_guarded_steps(std::uint32_t steps, AdvanceReport& report) {
  ForceModel force_model{*model, controls, work, runner, observer};
  for (std::uint32_t s = 0; s < steps; ++s) {
    force_model.step = state.step_count;
    if (!take_guarded_step(force_model, report)) return false;
    ++state.step_count;
    for (const AppliedForce& applied : controls.applied_forces) {
      // The forces that velocity Verlet keeps for the next step still have this one in them.
      if (applied.end_step == state.step_count) state.forces_current = false;
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

void AdvanceReport::add(const GuardEvent& event) {
  ++undone_steps;
  if (events.size() < kMaxEvents) {
    events.push_back(event);
  } else {
    events.back() = event;
  }
}

}  // namespace vat
