#include "core/device/incompressible/wet_solids.h"

namespace vat {

WetSolids::WetSolids(opencl::Program& program, const Model& model)
    : solids(program, model, guard_bounds(model)), pushes(program, model, solids), model_(model) {
  if (model.scene.numerics.control == StepControl::adaptive) limits.emplace(program, model, solids);
}

std::size_t WetSolids::bytes_for(const Model& model) {
  const bool is_adaptive = model.scene.numerics.control == StepControl::adaptive;
  return DeviceSolids::bytes_for(model) + DevicePushes::bytes_for(model) +
         (is_adaptive ? DeviceStepLimits::bytes_for(model) : 0);
}

void WetSolids::write(const State& state) {
  solids.write(state);
  find_mobilities(state.step_count);
}

void WetSolids::release(std::uint64_t step) {
  solids.release(step);
  find_mobilities(step);
}

void WetSolids::find_mobilities(std::uint64_t step) {
  pushes.find_mobilities(model_, step);
  if (limits) limits->find_mobilities(model_, step);
}

void WetSolids::find_forces(Real time, const LiquidParameters& p, DeviceParticles& particles) {
  solids.find_forces(time);
  particles.add_forces_on_solids(p, solids.force());
  solids.gather();
}

}  // namespace vat
