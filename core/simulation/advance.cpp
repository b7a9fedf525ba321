// The advance of a simulation: its steps, and the changes of bodies in between.

#include <algorithm>
#include <utility>

#include "core/simulation/simulation.h"
#include "core/simulation/simulation_impl.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Moves liquid particles that have left a periodic world to the opposite side. Solids stay whole,
/// and may move any distance.
void wrap_liquid(const Model& model, TaskRunner* runner, Configuration& configuration) {
  for_blocks(runner, model.liquid_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      configuration.position[i] = model.periodic.wrap(configuration.position[i]);
    }
  });
}

/// Tells the observer, if any, that a call has ended, also by an exception.
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

void SimulationImpl::melt_on_time(AdvanceReport& report) {
  wake_all();
  std::vector<MeltedBody> melting;
  for (std::size_t b = 0; b < model->bodies.size(); ++b) {
    if (model->bodies[b].melts_at > state.step_count) continue;
    melting.push_back({b, model->scene.bodies[b].melting->into});
  }
  melt(melting);
  report.bodies_changed = true;
}

bool SimulationImpl::bodies_change_at(std::uint64_t step) const {
  if (!model->scene.drains.empty() && step % steps_per_tick() == 0) return true;
  for (const ModelBody& body : model->bodies) {
    if (body.melts_at <= step) return true;
    if (model->nozzles.empty()) continue;
    const auto is_out = [&](const NozzleParticle& each) { return each.free_from <= step; };
    if (std::ranges::any_of(body.sample->in_nozzles, is_out)) return true;
  }
  const auto time_of = [&](std::uint64_t s) { return static_cast<Real>(s) * step_size(); };
  for (std::size_t e = 0; e < model->nozzles.size(); ++e) {
    const Nozzle& nozzle = model->nozzles[e];
    const std::uint64_t before = step == 0 ? 0 : nozzle.entered(time_of(step - 1));
    if (model->scene.emitters[e].open && nozzle.entered(time_of(step)) > before) return true;
  }
  return false;
}

std::uint32_t SimulationImpl::steps_until_change(std::uint32_t most) const {
  std::uint32_t steps = 1;
  while (steps < most && !bodies_change_at(state.step_count + steps)) ++steps;
  return steps;
}

void SimulationImpl::change_bodies_on_time(AdvanceReport& report) {
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

bool SimulationImpl::take_nominal_step(AdvanceReport& report) {
  ForceModel force_model{*model, controls, work, runner, observer};
  force_model.report = &report;
  force_model.step = state.step_count;
  return stepper.take_nominal_step({force_model, state, bounds, step_bounds, report});
}

bool SimulationImpl::take_guarded_steps(std::uint32_t steps, AdvanceReport& report) {
  for (std::uint32_t s = 0; s < steps; ++s) {
    change_bodies_on_time(report);
    if (!take_unchanged_steps(1, report)) return false;
  }
  return true;
}

bool SimulationImpl::take_parts(std::uint32_t steps, AdvanceReport& report) {
  while (steps > 0) {
    if (all_sleep()) return take_guarded_steps(steps, report);
    const bool sleeps = model->scene.sleeping.has_value();
    if (!sleeps || bodies_change_at(state.step_count)) {
      read_from_device();
      change_bodies_on_time(report);
    }
    std::uint32_t part = steps_until_change(steps);
    if (sleeps) part = sleep_and_wake_before(part);
    if (all_sleep() || !advance_on_device(part, report)) {
      if (!take_unchanged_steps(part, report, 1)) return false;
    }
    steps -= part;
  }
  return true;
}

bool SimulationImpl::take_unchanged_steps(std::uint32_t steps, AdvanceReport& report,
                                          std::uint32_t checked) {
  for (std::uint32_t s = 0; s < steps; ++s) {
    if (model->scene.sleeping && s >= checked) sleep_and_wake();
    if (!all_sleep() && !take_nominal_step(report)) return false;
    ++state.step_count;
    if (model->periodic.any()) {
      enter("wrap");
      wrap_liquid(*model, runner, state.now);
    }
    for (const AppliedForce& applied : controls.applied_forces) {
      // The forces that velocity Verlet keeps for the next step include this force.
      if (applied.end_step == state.step_count) state.forces_current = false;
    }
    for (const RigidModel& rigid : model->rigid_bodies) {
      // The kept forces do not act on a body that was held.
      if (rigid.free_from == state.step_count) state.forces_current = false;
    }
  }
  return true;
}

void SimulationImpl::begin_call() {
  call_start.content = static_cast<const SimulationContent&>(*this);
  call_start.bounds.reset();
}

void SimulationImpl::undo_call() noexcept {
  if (call_start.bounds) {
    adopt(std::move(call_start.content), std::move(call_start.bounds->first),
          std::move(call_start.bounds->second));
  } else {
    state = call_start.content.state;
    stepper.forget();
  }
  unread_steps = 0;
  device_is_current = false;
}

void SimulationImpl::read_from_device() {
  if (unread_steps == 0) return;
  const auto steps = static_cast<std::uint32_t>(std::exchange(unread_steps, 0));
  const Status read = engine->read(state);
  if (read) {
    show();
    return;
  }
  engine_error = read.errors().front();
  engine.reset();
  state.step_count -= steps;
  AdvanceReport repeated;
  if (!take_unchanged_steps(steps, repeated, steps))
    engine_error->message += "; the last steps are lost";
  show();
}

Result<bool> SimulationImpl::fit_engine(AdvanceReport& report) {
  if (engine_model == model) return engine_fits;
  VAT_CHECK(unread_steps == 0);  // a command reads the state before it changes the model
  const bool fitted = engine_fits;
  const Status bound = engine->bind(model, bounds);
  engine_model = model;
  engine_fits = bound.ok();
  device_is_current = false;
  if (!bound && !lacks_features(bound)) return bound.errors();
  if (!bound && fitted) report.device_error = bound.errors().front();
  return engine_fits;
}

bool SimulationImpl::advance_on_device(std::uint32_t steps, AdvanceReport& report) {
  if (engine == nullptr || steps == 0) return false;
  enter("device");
  const Result<bool> fits = fit_engine(report);
  if (fits && !fits.value()) return false;
  const Result<bool> taken =
      fits ? engine->advance({controls, state, report, device_is_current}, steps) : fits.errors();
  if (taken && taken.value()) {
    device_is_current = true;
    state.step_count += steps;
    unread_steps += steps;
    report.device_steps += steps;
    return true;
  }
  read_from_device();
  device_is_current = false;
  if (!taken) {
    report.device_error = taken.errors().front();
    engine.reset();
  }
  return false;
}

AdvanceReport Simulation::advance(std::uint32_t steps) {
  SimulationImpl& impl = impl_.unread();
  VAT_CHECK(impl.model != nullptr);
  AdvanceReport report;
  const ObservedCall call(impl.observer);
  const bool is_on_device = impl.engine != nullptr && steps > 0 && !impl.all_sleep();
  bool changes = is_on_device && (impl.bodies_change_at(impl.state.step_count) ||
                                  impl.steps_until_change(steps) < steps);
  if (is_on_device && !changes && impl.model->scene.sleeping) {
    if (impl.advance_quietly_on_device(steps, report)) return report;
    changes = true;
  }
  if (changes) {
    impl.read_from_device();
  } else if (is_on_device && impl.advance_on_device(steps, report)) {
    return report;
  }
  if (impl.engine_error) report.device_error = std::exchange(impl.engine_error, std::nullopt);
  impl.enter("keep_state");
  impl.begin_call();
  try {
    report.failed =
        !(changes ? impl.take_parts(steps, report) : impl.take_guarded_steps(steps, report));
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
  if (impl.unread_steps > 0) return report;
  if (!impl.model->rigid_bodies.empty()) impl.enter("pose_rigid_bodies");
  impl.pose_rigid_particles();
  impl.show();
  return report;
}

}  // namespace vat
