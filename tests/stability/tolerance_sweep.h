#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

/// Runs of incompressible liquids over the whole range of their tolerances.
namespace vat::stability {

inline constexpr const char* kToleranceScenes[] = {"dam-break", "buoyancy", "sloshing-tank",
                                                   "deep-tank", "flat-dam-break"};

/// A run with one value for both tolerances.
struct TolerancePoint {
  std::string scene;
  Real tolerance = 0;
  bool failed = false;           ///< the guard ended the run
  Real density_error = 0;        ///< maximum over the ticks of the mean over the particles
  Real energy_gain = 0;          ///< maximum rise of the total energy above its first value [J]
  Real released = 0;             ///< maximum fall of the gravitational energy [J]
  std::uint64_t steps = 0;       ///< including undone ones
  Real velocity_iterations = 0;  ///< per step, mean over all steps
  Real position_iterations = 0;  ///< the same
  double seconds = 0;            ///< wall time of the steps

  /// Matrix products of the run, with two for the pairs and forces of a step. A measure of its cost
  /// that does not depend on the machine.
  Real products() const;
};

/// Returns a scene with these tolerances and adaptive steps.
Scene tolerance_scene(const std::string& name, Real tolerance);

/// Simulates `seconds` [s] of a scene.
TolerancePoint measure_tolerance(const std::string& name, Real tolerance, Real seconds);

/// Returns tolerances from 1e-5 to 0.1, the range of the scene format.
std::vector<Real> all_tolerances();

}  // namespace vat::stability
