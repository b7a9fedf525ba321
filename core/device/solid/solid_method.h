#pragma once

#include <cstddef>
#include <memory>

#include "core/device/common/verlet_method.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/device_solids.h"
#include "core/guard/guard.h"
#include "core/model/model.h"

namespace vat {

/// The fixed steps of the bodies of DeviceSolids, by the integrator of the scene. The functions
/// throw opencl::DeviceFailure.
class SolidMethod : public VerletMethod {
 public:
  SolidMethod(opencl::Program& program, std::shared_ptr<const Model> bodies,
              const GuardBounds& bounds);

  void read(State& state) override;
  void read_motions(BodyMotions& motions) override { solids_.read_motions(motions); }

 protected:
  void evaluate(const StepMoment& start, Real end) override;
  /// Moves the bodies from start.time to `end` [s].
  void move(const StepMoment& start, Real end);

  DeviceSolids& solids() { return solids_; }

 private:
  DeviceCounters& counters() override { return counters_; }
  void write(const State& state) override { solids_.write(state); }
  void release(std::uint64_t step) override { solids_.release(step); }
  void save() override { solids_.save(); }
  void restore() override { solids_.restore(); }
  bool must_solve(Real dt) const override { return solids_.must_solve(dt); }
  std::uint32_t solve_damping(Real end, Real dt) override { return solids_.solve_damping(end, dt); }
  void finish(const StepMoment& moment) override;
  void wrap_liquid() override { solids_.wrap_liquid(); }
  void count_work(AdvanceReport& report) override { solids_.count_work(report); }
  bool take_nominal_steps(const NominalSteps& steps, AdvanceReport& report) override;
  bool keeps_forces() const;

  DeviceCounters counters_;
  DeviceSolids solids_;
};

/// Returns the bytes that the steps of a model without liquids need on the device.
std::size_t bytes_for_solids(const Model& model);

/// Returns the steps of deformable and rigid bodies, with the kernels of core/device/solid. Throws
/// opencl::DeviceFailure.
std::unique_ptr<DeviceMethod> make_solid_method(opencl::Program& program,
                                                std::shared_ptr<const Model> model,
                                                const GuardBounds& bounds);

}  // namespace vat
