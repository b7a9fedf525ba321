#pragma once

#include <cstddef>
#include <cstdint>

#include "core/device/liquid/device_particles.h"
#include "core/device/opencl/program.h"
#include "core/model/model.h"

namespace vat {

/// The struct Cohesion of core/device/liquid/cohesion.cl, with the same members in the same order.
struct CohesionParameters {
  float pull;
  float pull_of_solid;
  float inverse_far;
  float inverse_near;
  float far_slope;
  float near_slope;
  float far_plane;
  float near_plane;
  float wall_share;
  std::int32_t dimensions;
};

/// Cohesion of one liquid, and its adhesion to walls and solids, on a device. The forces have the
/// formulas of core/liquid/surface/cohesion.h. If the device fails, each function throws
/// opencl::DeviceFailure.
class DeviceCohesion {
 public:
  DeviceCohesion(opencl::Program& program, const Model& model);
  static std::size_t bytes_for(const Model& model);

  /// Adds the forces of the sorted `particles` to the `acceleration` of the liquid, in the order of
  /// particles.
  void add_forces(const LiquidParameters& p, const DeviceParticles& particles,
                  const opencl::Buffer& acceleration);
  /// Adds the forces of the liquid to the `force` on solids, in the order of their particles.
  void add_forces_on_solids(const LiquidParameters& p, const DeviceParticles& particles,
                            const opencl::Buffer& force);

 private:
  opencl::Program& program_;
  const CohesionParameters parameters_;
  opencl::Buffer shares_;  ///< attraction by the liquid, relative to that of liquids
};

}  // namespace vat
