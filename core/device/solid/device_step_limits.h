#pragma once

#include <cstddef>
#include <cstdint>

#include "core/device/opencl/program.h"
#include "core/device/solid/device_solids.h"
#include "core/guard/guard.h"
#include "core/model/model.h"

namespace vat {

/// The limits of adaptive steps by rigid bodies, see core/device/solid/step_limits.cl. The
/// functions throw opencl::DeviceFailure.
class DeviceStepLimits {
 public:
  /// `solids` must outlive this object.
  DeviceStepLimits(opencl::Program& program, const Model& model, const DeviceSolids& solids);
  static std::size_t bytes_for(const Model& model);

  /// Writes the mobilities of the particles in `step`.
  void find_mobilities(const Model& model, std::uint64_t step);
  /// Returns the step that PresentSteps::rigid would give at `time` [s], after
  /// DeviceSolids::place(). Contacts are predicted for steps of at most `longest` [s].
  /// `liquid_speed` is the greatest speed of the liquid [m/s].
  Real least_step(const Model& model, Real time, Real longest, Real liquid_speed);

 private:
  /// The struct StepSearch of step_limits.cl.
  struct Search {
    double longest;
    double gained_speed;          ///< by gravity in `longest` [m/s]
    double gained_in_approach;    ///< the same, if forces of gravity are off, too [m/s]
    double approach_of_liquid;    ///< greatest way of a particle of the liquid [m]
    double reach;                 ///< Model::contact_reach [m]
    double vat_speed;             ///< see greatest_vat_speed() [m/s]
    double scene_step;            ///< see StepBounds [s]
    double travel_share;          ///< kTravelShare
    double margin;                ///< safe step / stable step
    double phase;                 ///< see contact_phase()
    double full_amplitude;        ///< kFullAmplitude
    double greatest_turn;         ///< kGreatestTurn [rad]
    std::int32_t damping_limits;  ///< 1: damping reduces the stable step
    std::int32_t padding;
  };
  Search search_for(const Model& model, Real time, Real longest, Real liquid_speed) const;

  opencl::Program& program_;
  const DeviceSolids& solids_;
  const Real scene_step_;     ///< [s]
  const Real liquid_travel_;  ///< see GuardBounds [m]
  const std::size_t free_, count_, bodies_;
  opencl::Buffer mobility_, approach_, predictions_, partial_, steps_, least_;
};

}  // namespace vat
