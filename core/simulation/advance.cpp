// The stepping of Simulation, under the guard.

#include <algorithm>
#include <cmath>

#include "core/contact/scratch.h"
#include "core/guard/enforce_walls.h"
#include "core/limits.h"
#include "core/liquid/pairs/scratch.h"
#include "core/numerics/error_model.h"
#include "core/simulation/simulation.h"
#include "core/simulation/simulation_impl.h"
#include "core/simulation/wrap.h"
#include "core/solid/spring_changes.h"

namespace vat {
namespace {

constexpr int kMaxHalvings = 3;

/// Tells the observer, if any, that a call has ended, however it did.
class ObservedCall {
 public:
  explicit ObservedCall(StageObserver* observer) : observer_(observer) {}
  ~ObservedCall() {
    if (observer_ != nullptr) observer_->stages_end();
  }
  ObservedCall(const ObservedCall&) = delete;
  ObservedCall& operator=(const ObservedCall&) = delete;

 private:
  StageObserver* observer_;
};

}  // namespace

void Simulation::Impl::take_unguarded_step(const ForceModel& force_model, Real start, Real dt,
                                           AdvanceReport& report) {
  const Numerics& numerics = model->scene.numerics;
  if (numerics.control != StepControl::local) {
    take_step(numerics.integrator, force_model, state, start, dt, scratch);
    report.count_steps(1, dt, dt);
    return;
  }
  local.take_step(force_model, state, start, dt, step_bounds, bounds);
  if (change_springs(*model, runner, state.now, dt)) {
    state.forces_current = false;
    local.forget();
  }
  report.count_steps(1U << local.finest(), std::ldexp(dt, -local.finest()),
                     std::ldexp(dt, -local.coarsest()));
}

void Simulation::Impl::undo_step() {
  state.now = step_start;
  state.forces_current = false;
  local.forget();
}

bool Simulation::Impl::hold_inside_vat(Real end, AdvanceReport& report) {
  enter("enforce_walls");
  // Parts of a step need not add up to the bit, but at its end the vat is where a view sees it.
  const Real nominal_end = static_cast<Real>(state.step_count + 1) * step_size();
  const Real least_part = std::ldexp(step_size(), -kMaxStepLevel - kMaxHalvings);
  if (std::abs(end - nominal_end) < least_part / 2) end = nominal_end;
  const std::uint64_t stops =
      enforce_walls(*model, bounds, {end, state.step_count}, step_start, runner, state.now);
  if (stops == 0) return false;
  report.wall_stops += stops;
  state.forces_current = false;
  local.forget();
  return true;
}

std::optional<Fault> Simulation::Impl::find_step_fault(Real dt) const {
  enter("guard");
  if (work.of<LiquidScratch>().too_many_pairs) {  // of liquids, whose particles come first
    return Fault{GuardEvent::Cause::too_many_pairs, model->body[0], 0};
  }
  if (work.of<ContactForceScratch>().too_many_contacts)
    return Fault{GuardEvent::Cause::too_many_pairs, 0, 0};
  const auto fault = find_fault(*model, state.now, bounds, std::ldexp(dt, -local.finest()), runner);
  if (fault || model->scene.numerics.control != StepControl::local) return fault;
  return local.find_fast(*model, state.now, dt, bounds);
}

namespace {

Index number_of(const ModelBody& body, Index particle) {
  const bool is_plain = !body.sample || body.sample->numbers.empty();
  return is_plain ? particle : body.sample->numbers[particle];
}

}  // namespace

std::optional<GuardEvent> Simulation::Impl::take_step_in(std::uint32_t pieces,
                                                         const ForceModel& force_model, Real start,
                                                         Real whole, AdvanceReport& report) {
  const Real dt = whole / pieces;
  for (std::uint32_t piece = 0; piece < pieces; ++piece) {
    take_unguarded_step(force_model, start + piece * dt, dt, report);
    // What left is judged as it left, and again as the plane returns it.
    std::optional<Fault> fault = find_step_fault(dt);
    if (!fault && hold_inside_vat(start + (piece + 1) * dt, report)) fault = find_step_fault(dt);
    if (fault) {
      return GuardEvent{fault->cause,
                        start + (piece + 1) * dt,
                        model->bodies[fault->body].id,
                        number_of(model->bodies[fault->body], fault->particle),
                        dt,
                        true};
    }
  }
  return {};
}

bool Simulation::Impl::take_guarded_step(const ForceModel& force_model, Real start, Real dt,
                                         AdvanceReport& report) {
  const std::size_t earlier_events = report.events.size();
  enter("keep_state");
  copy(state.now, runner, step_start);
  for (int halvings = 0; halvings <= kMaxHalvings; ++halvings) {
    const auto event = take_step_in(1U << halvings, force_model, start, dt, report);
    if (!event) {
      // Local control chose the levels that open the next step for one of this length.
      if (halvings > 0 && model->scene.numerics.control == StepControl::local) {
        state.forces_current = false;
      }
      return true;
    }
    report.add(*event);
    undo_step();
  }
  for (std::size_t e = std::min(earlier_events, report.events.size() - 1); e < report.events.size();
       ++e) {
    report.events[e].recovered = false;
  }
  return false;
}

Real Simulation::Impl::probe_start(const ForceModel& force_model, Real start, Real dt) {
  copy(state.now, runner, step_start);
  state.forces_current = false;
  probe.begin(state);
  force_model.evaluate(state.now, start, state.forces);
  enter("choose_step");
  const Forces forces = state.forces;
  if (model->damping.any) state.bound = find_bound(force_model, state.now);
  kick(*model, runner, forces, state.now, dt / 2);
  drift(*model, runner, state.now, dt);
  force_model.evaluate(state.now, start + dt, state.forces);
  enter("choose_step");
  state.now = step_start;
  state.forces = forces;
  state.forces_current = model->scene.numerics.integrator == IntegratorId::velocity_verlet;
  return probe.observed_rate(*model);
}

Real Simulation::Impl::wanted_step(const ForceModel& force_model, Real start) {
  enter("choose_step");
  const Numerics& numerics = model->scene.numerics;
  if (numerics.control == StepControl::local) {
    return greatest_base_step(force_model, state, step_bounds);
  }
  // Nobody need look further ahead: a step is at most twice as long as the one before.
  const Real last = state.history.step;
  const Real longest = last > 0 ? std::min(numerics.step, 2 * last) : numerics.step;
  find_present_steps(force_model, state, start, longest, step_bounds, bounds, present_steps);
  Real step = present_steps.least();
  if (last == 0) {
    constexpr Real kShort = 0.1;  // of the first step
    state.history.observed_rate =
        probe_start(force_model, start, kShort * std::min(step, numerics.step));
  }
  if (state.history.observed_rate > 0) {
    step = std::min(step, resolving_phase_of_places(numerics) / state.history.observed_rate);
  }
  return without_viscosity_solve(*model, std::min(step, numerics.step));
}

bool Simulation::Impl::take_varied_step(ForceModel& force_model, AdvanceReport& report) {
  const bool is_local = model->scene.numerics.control == StepControl::local;
  if (!is_local) force_model.probe = &probe;
  for (Real left = step_size(); left > 0;) {
    const Real start = time() + (step_size() - left);
    const Real last = state.history.step;
    const std::uint32_t count =
        choose_step_count(wanted_step(force_model, start), left, step_size(), state.history);
    const Real dt = state.history.step;
    const bool is_same = std::abs(dt - last) <= 1e-9 * dt;  // but for rounding
    if (is_local && !is_same) state.forces_current = false;
    probe.begin(state);
    if (!take_guarded_step(force_model, start, dt, report)) return false;
    if (!is_local) state.history.observed_rate = probe.observed_rate(*model);
    ++state.history.held;
    left = count == 1 ? 0 : left - dt;
  }
  return true;
}

void Simulation::Impl::melt_on_time(AdvanceReport& report) {
  wake_all();
  std::vector<MeltedBody> melting;
  for (std::size_t b = 0; b < model->bodies.size(); ++b) {
    if (model->bodies[b].melts_at > state.step_count) continue;
    melting.push_back({b, model->scene.bodies[b].melting->into});
  }
  melt(melting);
  report.bodies_changed = true;
}

void Simulation::Impl::change_bodies_on_time(AdvanceReport& report) {
  const bool may_flow = !model->nozzles.empty() || !model->scene.drains.empty();
  const bool may_melt = std::ranges::any_of(
      model->bodies, [&](const ModelBody& body) { return body.melts_at <= state.step_count; });
  if (!may_flow && !may_melt) return;
  enter("change_bodies");
  std::vector<std::uint64_t> grabs;
  for (const Grab& grab : controls.grabs) grabs.push_back(grab.id);
  if (may_melt) melt_on_time(report);
  if (may_flow) flow();
  for (const std::uint64_t grab : grabs) {
    if (std::ranges::find(controls.grabs, grab, &Grab::id) != controls.grabs.end()) continue;
    report.ended_grabs.push_back(grab);
  }
}

bool Simulation::Impl::take_nominal_step(AdvanceReport& report) {
  ForceModel force_model{*model, controls, work, runner, observer};
  force_model.report = &report;
  force_model.step = state.step_count;
  if (model->scene.numerics.control == StepControl::fixed) {
    return take_guarded_step(force_model, time(), step_size(), report);
  }
  return take_varied_step(force_model, report);
}

bool Simulation::Impl::take_guarded_steps(std::uint32_t steps, AdvanceReport& report) {
  for (std::uint32_t s = 0; s < steps; ++s) {
    change_bodies_on_time(report);
    if (model->scene.sleeping) sleep_and_wake();
    const bool all_sleep = sleepers && model->bodies.empty();
    if (!all_sleep && !take_nominal_step(report)) return false;
    ++state.step_count;
    if (model->periodic.any()) {
      enter("wrap");
      wrap_liquid(*model, runner, state.now);
    }
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

void Simulation::Impl::begin_call() {
  call_start.content = static_cast<const Content&>(*this);
  call_start.bounds.reset();
}

void Simulation::Impl::undo_call() noexcept {
  if (call_start.bounds) {
    adopt(std::move(call_start.content), std::move(call_start.bounds->first),
          std::move(call_start.bounds->second));
  } else {
    state = call_start.content.state;
    local.forget();
  }
}

AdvanceReport Simulation::advance(std::uint32_t steps) {
  Impl& impl = *impl_;
  AdvanceReport report;
  const ObservedCall call(impl.observer);
  impl.enter("keep_state");
  impl.begin_call();
  try {
    report.failed = !impl.take_guarded_steps(steps, report);
  } catch (...) {  // out of memory
    impl.undo_call();
    throw;
  }
  if (report.failed) {
    impl.undo_call();
    report.bodies_changed = false;
    report.ended_grabs.clear();
  }
  std::erase_if(impl.controls.applied_forces, [&](const AppliedForce& applied) {
    return applied.end_step <= impl.state.step_count;
  });
  if (!impl.model->rigid_bodies.empty()) impl.enter("pose_rigid_bodies");
  impl.pose_rigid_particles();
  impl.show();
  return report;
}

}  // namespace vat
