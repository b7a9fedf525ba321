#pragma once

#include <cstddef>
#include <vector>

#include "core/device/liquid/device_particles.h"
#include "core/device/liquid/liquid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/model/model.h"
#include "core/state/state.h"

namespace vat {

/// The struct Transport of transport.cl.
struct TransportParameters {
  float gradient;
  float strength;
};

/// The transport velocities of a liquid that fills its world (Model::is_filled) on a device. The
/// functions throw opencl::DeviceFailure.
class DeviceTransport {
 public:
  DeviceTransport(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Writes the velocities of a state, or 0 if it has none.
  void write(const Forces& from);
  /// Reads the velocities. The function copy_to() then writes them.
  void read();
  void copy_to(Forces& to) const;
  /// Saves the present velocities, or returns to the saved ones.
  void save();
  void restore();

  /// Returns the velocities, in the order of particles.
  const opencl::Buffer& velocities() const { return transport_; }

  /// Moves the liquid for `dt` [s].
  void drift(Real dt, const opencl::Buffer& position);
  /// Computes the velocities of the sorted `particles`. Adds their momentum transport to
  /// `acceleration`.
  void add_forces(const LiquidParameters& p, const DeviceParticles& particles,
                  const opencl::Buffer& acceleration);

 private:
  opencl::Program& program_;
  const std::size_t count_;  ///< liquid particles
  const TransportParameters parameters_;
  opencl::Buffer transport_, saved_, sorted_;
  std::vector<Float4> read_;
};

}  // namespace vat
