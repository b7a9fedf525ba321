#pragma once

#include <memory>
#include <vector>

#include "core/sleep/resting_bodies.h"
#include "core/state/state.h"

namespace vat {

/// All bodies of a simulation in which some bodies sleep. The value is constant while the same
/// bodies sleep. Awake bodies are stepped in a separate model.
struct Sleepers {
  /// `islands` contains the sleeping islands, by body. At least one body sleeps, or all bodies are
  /// still.
  Sleepers(std::shared_ptr<const Model> model, Configuration all, std::vector<Index> islands);

  std::shared_ptr<const Model> model;  ///< all bodies
  Configuration configuration;         ///< all bodies; out of date for awake bodies
  std::vector<Index> islands;          ///< by body; kAwake for stepped bodies
  RestingBodies resting;               ///< only the sleeping bodies
};

/// If all bodies that are not still sleep (see is_still()), puts each still body to sleep as a
/// separate island. Otherwise, still bodies are awake.
void settle_still_bodies(const Model& model, const Configuration& at, std::vector<Index>& islands);

/// Returns the model of the awake bodies.
std::shared_ptr<const Model> compile_awake(const Model& model, const std::vector<Index>& islands);

/// Sets the velocities of the bodies in islands to zero.
void stop(const Model& model, const std::vector<Index>& islands, Configuration& at);

}  // namespace vat
