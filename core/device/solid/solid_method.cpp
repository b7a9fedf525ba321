#include "core/device/solid/solid_method.h"

#include <utility>

#include "core/device/common/device_counters.h"
#include "core/device/solid/device_solids.h"

namespace vat {
namespace {

using opencl::Program;

class SolidMethod : public DeviceMethod {
 public:
  SolidMethod(Program& program, std::shared_ptr<const Model> model, const GuardBounds& bounds)
      : model_(std::move(model)), counters_(program), solids_(program, *model_, bounds) {}

  bool take_steps(const EngineInput& input, std::uint32_t steps) override;
  void read(State& state) override;

 private:
  /// Moves the particles by `start`, and evaluates the forces at the time `end`.
  void evaluate(const StepMoment& start, Real end);
  /// Takes a step whose kick and drift begin with `moment`.
  void take_step(StepMoment moment, Real end, AdvanceReport& report);

  const std::shared_ptr<const Model> model_;
  DeviceCounters counters_;
  DeviceSolids solids_;
};

void SolidMethod::read(State& state) {
  solids_.read();
  state.forces.particle.resize(model_->particle_count);
  solids_.copy_to(state);
  state.forces_current = true;
  if (model_->damping.any) state.bound = solids_.bound();
}

void SolidMethod::evaluate(const StepMoment& start, Real end) {
  solids_.move(start, end, model_->scene.numerics.step, counters_.buffer);
  solids_.find_forces(end);
  solids_.gather();
}

void SolidMethod::take_step(StepMoment moment, Real end, AdvanceReport& report) {
  const bool must_solve = solids_.must_solve(moment.drift);
  // Forces with a solve depend on the velocities before it; see evaluate_at_end().
  moment.prediction = model_->damping.any && !must_solve ? moment.opening : 0;
  evaluate(moment, end);
  if (must_solve) report.iterations.damping += solids_.solve_damping(end, moment.opening);
}

bool SolidMethod::take_steps(const EngineInput& input, std::uint32_t steps) {
  const State& state = input.state;
  const Real dt = model_->scene.numerics.step;
  const auto time = [&](std::uint32_t s) { return static_cast<Real>(state.step_count + s) * dt; };
  if (!input.continues) solids_.write(state);
  solids_.save();
  counters_.clear();
  AdvanceReport report = input.report;
  if (!input.continues && !state.forces_current) {
    evaluate({time(0), 0, 0, 0, 0}, time(0));
    report.count_evaluation(model_->particle_count);
  }
  StepMoment moment{0, 0, dt / 2, dt, 0};
  for (std::uint32_t s = 0; s < steps; ++s) {
    moment.time = time(s);
    take_step(moment, moment.time + dt, report);
    report.count_evaluation(model_->particle_count);
    moment.closing = dt / 2;
  }
  moment.time = time(steps);
  solids_.finish(moment, dt, counters_.buffer);
  const Counters counters = counters_.read();
  if (counters.faults != 0) {
    solids_.restore();
    return false;
  }
  report.count_steps(steps, dt, dt);
  report.wall_stops += static_cast<std::uint64_t>(counters.stops);
  input.report = std::move(report);
  return true;
}

}  // namespace

std::size_t bytes_for_solids(const Model& model) {
  return DeviceSolids::bytes_for(model);
}

std::unique_ptr<DeviceMethod> make_solid_method(Program& program,
                                                std::shared_ptr<const Model> model) {
  const GuardBounds bounds = guard_bounds(*model);
  return std::make_unique<SolidMethod>(program, std::move(model), bounds);
}

}  // namespace vat
