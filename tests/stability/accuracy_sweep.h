#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/scene/scene.h"

/// Runs with a requested accuracy, over its whole range.
namespace vat::stability {

/// Scenes with an oscillator that has a closed-form solution, alone and beside bodies with other
/// solves: a ball that bounces on penalties, a block that slides under projected contacts, and a
/// rope of implicit springs.
inline constexpr const char* kAccuracyScenes[] = {"oscillator", "bouncing-ball",
                                                  "projected-contacts", "implicit-springs"};

struct AccuracyPoint {
  std::string scene;
  Real accuracy = 0;
  bool failed = false;  ///< a step failed
  Real error = 0;       ///< of the oscillator after 100 radians, relative to its amplitude
  std::uint64_t steps = 0;
  std::uint64_t evaluations = 0;  ///< of the forces
  std::uint64_t iterations = 0;   ///< sweeps over contacts and passes over implicit springs

  /// A measure of the cost that does not depend on the machine.
  std::uint64_t work() const { return evaluations + iterations; }
};

Scene accuracy_scene(const std::string& name, Real accuracy);

/// Simulates 100 radians of the oscillator of a scene.
AccuracyPoint measure_accuracy(const std::string& name, Real accuracy);

/// Returns accuracies from 1e-5 to 0.1, the upper limit of the scene format.
std::vector<Real> all_accuracies();

}  // namespace vat::stability
