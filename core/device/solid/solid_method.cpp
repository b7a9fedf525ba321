#include "core/device/solid/solid_method.h"

#include <utility>

#include "core/stepping/integrator.h"

namespace vat {

using opencl::Program;

SolidMethod::SolidMethod(Program& program, std::shared_ptr<const Model> bodies,
                         const GuardBounds& bounds)
    : VerletMethod(std::move(bodies)), counters_(program), solids_(program, model(), bounds) {}

void SolidMethod::read(State& state) {
  solids_.read();
  state.forces.particle.resize(model().particle_count);
  solids_.copy_to(state);
  if (!keeps_forces()) return;
  state.forces_current = !releases_body(model(), state.step_count);
  if (model().damping.any) state.bound = solids_.bound();
}

bool SolidMethod::keeps_forces() const {
  return integrator_of(model().scene.numerics.integrator).keeps_forces();
}

bool SolidMethod::take_nominal_steps(const NominalSteps& steps, AdvanceReport& report) {
  if (keeps_forces()) return VerletMethod::take_nominal_steps(steps, report);
  for (std::uint32_t s = 0; s < steps.count; ++s) {
    solids_.integrate(steps.time(s), steps.time(s + 1), steps.step, counters_.buffer,
                      [&](Real time) { evaluate_at_start(time, report); });
    wrap_liquid();
  }
  report.count_steps(steps.count, steps.step, steps.step);
  // Springs change before walls stop their particles.
  return !solids_.springs_change() || counters_.read().stops == 0;
}

void SolidMethod::move(const StepMoment& start, Real end) {
  solids_.move(start, end, model().scene.numerics.step, counters_.buffer);
}

void SolidMethod::evaluate(const StepMoment& start, Real end) {
  move(start, end);
  solids_.find_forces(end);
  solids_.gather();
}

void SolidMethod::finish(const StepMoment& moment) {
  solids_.finish(moment, model().scene.numerics.step, counters_.buffer);
}

std::size_t bytes_for_solids(const Model& model) {
  return DeviceSolids::bytes_for(model);
}

std::unique_ptr<DeviceMethod> make_solid_method(Program& program,
                                                std::shared_ptr<const Model> model,
                                                const GuardBounds& bounds) {
  return std::make_unique<SolidMethod>(program, std::move(model), bounds);
}

}  // namespace vat
