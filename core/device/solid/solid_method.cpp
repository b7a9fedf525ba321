#include "core/device/solid/solid_method.h"

#include <utility>

#include "core/device/common/verlet_method.h"
#include "core/device/solid/device_solids.h"

namespace vat {
namespace {

using opencl::Program;

class SolidMethod : public VerletMethod {
 public:
  SolidMethod(Program& program, std::shared_ptr<const Model> bodies, const GuardBounds& bounds)
      : VerletMethod(std::move(bodies)), counters_(program), solids_(program, model(), bounds) {}

  void read(State& state) override;

 private:
  DeviceCounters& counters() override { return counters_; }
  void write(const State& state) override { solids_.write(state); }
  void save() override { solids_.save(); }
  void restore() override { solids_.restore(); }
  void evaluate(const StepMoment& start, Real end) override;
  bool must_solve(Real dt) const override { return solids_.must_solve(dt); }
  std::uint32_t solve_damping(Real end, Real dt) override { return solids_.solve_damping(end, dt); }
  void finish(const StepMoment& moment) override {
    solids_.finish(moment, model().scene.numerics.step, counters_.buffer);
  }

  DeviceCounters counters_;
  DeviceSolids solids_;
};

void SolidMethod::read(State& state) {
  solids_.read();
  state.forces.particle.resize(model().particle_count);
  solids_.copy_to(state);
  state.forces_current = true;
  if (model().damping.any) state.bound = solids_.bound();
}

void SolidMethod::evaluate(const StepMoment& start, Real end) {
  solids_.move(start, end, model().scene.numerics.step, counters_.buffer);
  solids_.find_forces(end);
  solids_.gather();
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
