#pragma once

#include <memory>
#include <vector>

#include "core/sleep/islands.h"
#include "core/sleep/resting_bodies.h"
#include "core/state/state.h"

namespace vat {

/// All bodies of a simulation in which some sleep. Constant as long as the same bodies sleep; the
/// others are stepped in a separate model.
struct Sleepers {
  /// `islands`: the sleeping islands, by body. At least one sleeps, or all bodies are still.
  Sleepers(std::shared_ptr<const Model> model, Configuration all, std::vector<Index> islands);

  std::shared_ptr<const Model> model;  ///< of all bodies
  Configuration configuration;         ///< of all bodies; out of date for those that are awake
  std::vector<Index> islands;          ///< by body; kAwake if it is stepped
  RestingBodies resting;               ///< the sleeping bodies
};

/// Puts each still body to sleep as a separate island, if no body is stepped. Otherwise still
/// bodies are awake.
void settle_still_bodies(const Model& model, const Configuration& at, std::vector<Index>& islands);

/// The model of the bodies that are awake.
std::shared_ptr<const Model> compile_awake(const Model& model, const std::vector<Index>& islands);

/// Sets the velocities of the bodies in islands to zero.
void stop(const Model& model, const std::vector<Index>& islands, Configuration& at);

}  // namespace vat
