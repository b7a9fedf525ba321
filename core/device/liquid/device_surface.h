#pragma once

#include <cstddef>

#include "core/device/liquid/device_particles.h"
#include "core/device/opencl/program.h"
#include "core/model/model.h"

namespace vat {

/// The struct Surface of core/device/liquid/surface.cl, with the same members in the same order.
struct SurfaceParameters {
  float slope;
  float threshold;
  float spread;
  float lift;
  float tension;
  float cohesion;
  float cosine;
  float sine;
};

/// Surface tension of one liquid by curvature, on a device. The forces are those of
/// core/liquid/surface/surface_tension.h. The functions throw opencl::DeviceFailure.
class DeviceSurface {
 public:
  DeviceSurface(opencl::Program& program, const Model& model);
  static std::size_t bytes_for(const Model& model);

  /// Adds the forces of the sorted `particles` to `acceleration`, which is in the order of
  /// particles.
  void add_forces(const LiquidParameters& p, const DeviceParticles& particles,
                  const opencl::Buffer& acceleration);

 private:
  opencl::Program& program_;
  const SurfaceParameters parameters_;
  const std::size_t liquid_count_;
  const bool is_periodic_;
  const bool is_balanced_;                     ///< the liquid touches neither walls nor solids
  opencl::Buffer surface_, normals_, curved_;  ///< by slot
  opencl::Buffer partial_, results_;
};

}  // namespace vat
