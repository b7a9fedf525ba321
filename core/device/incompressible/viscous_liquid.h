#pragma once

#include <cstddef>
#include <cstdint>

#include "core/device/incompressible/device_solve.h"
#include "core/device/liquid/device_particles.h"
#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/device/tait/device_viscosity.h"
#include "core/model/model.h"

namespace vat {

/// The kick of an incompressible liquid whose viscosity needs a solve. The functions throw
/// opencl::DeviceFailure.
class ViscousLiquid {
 public:
  ViscousLiquid(opencl::Program& program, const Model& model)
      : program_(program),
        viscosity_(program, model),
        acceleration_(program, model.liquid_count * sizeof(Float4)) {}
  static std::size_t bytes_for(const Model& model) {
    return DeviceViscosity::bytes_for(model) + model.liquid_count * sizeof(Float4);
  }

  /// Changes the velocities by the forces over solve.dt. Sets `solve_motion` as the kernel `kick`.
  /// Returns the number of iterations.
  std::uint32_t kick(const LiquidParameters& p, const SolveParameters& solve, DeviceParticles& s,
                     const opencl::Buffer& velocity, const opencl::Buffer& solve_motion) {
    program_.run_in_lanes("find_acceleration", s.count(), p, s.cells.begins, s.order,
                          s.sorted_place, s.sorted_motion, s.neighbour_counts, s.plain_counts,
                          s.neighbours, acceleration_);
    const std::uint32_t iterations = viscosity_.solve(p, s, velocity, solve.dt, acceleration_);
    program_.run("kick_by_accelerations", s.count(), p, solve, s.order, s.sorted_place,
                 acceleration_, velocity, solve_motion);
    return iterations;
  }

 private:
  opencl::Program& program_;
  DeviceViscosity viscosity_;
  opencl::Buffer acceleration_;
};

}  // namespace vat
