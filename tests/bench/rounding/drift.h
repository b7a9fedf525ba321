#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/device_choice.h"
#include "core/scene/scene.h"
#include "core/support/result.h"

namespace vat::bench {

/// A scene whose method conserves momentum and angular momentum, or the kinetic energy, so that
/// rounding errors alone change them.
struct ConservingScene {
  std::string name;
  Scene scene;
  Real precision;             ///< relative rounding error of the sums over pairs
  bool is_of_energy = false;  ///< the momenta are a part of the state, and cannot change
};

std::vector<ConservingScene> conserving_scenes();

/// The greatest changes of sums over all particles in a run.
struct Drift {
  Real momentum = 0;          ///< relative to the sum of m |v| at the start
  Real angular_momentum = 0;  ///< relative to the sum of m |v| |x| at the start
  Real energy = 0;            ///< relative to the kinetic energy at the start
  Real change = 0;  ///< mean of the sum of m |v - v'| per step, relative to the sum of m |v|
};

/// Runs a scene for `steps`, a multiple of kDriftInterval, on the CPU or a device. Fails if a step
/// fails or the device does not take it.
Result<Drift> measure_drift(const ConservingScene& one, const std::optional<DeviceChoice>& device,
                            std::uint64_t steps);
inline constexpr std::uint32_t kDriftInterval = 1000;  ///< steps between two measurements

/// Returns a bound of each relative drift: every step has kOperations rounded operations per
/// particle. The errors of velocities are relative to these, and those of sums over pairs to the
/// changes of velocities. No error cancels another one.
Real drift_bound(const ConservingScene& one, const Drift& drift, std::uint64_t steps);
inline constexpr Real kOperations = 64;

}  // namespace vat::bench
