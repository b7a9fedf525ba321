#pragma once

#include <memory>
#include <vector>

#include "core/sleep/islands.h"
#include "core/sleep/resting_bodies.h"
#include "core/state/state.h"

namespace vat {

/// All bodies of a simulation of which some sleep. Constant while the same ones do: the others are
/// stepped in a model of their own.
struct Sleepers {
  /// `islands` that sleep, by body; at least one does, or all bodies are still.
  Sleepers(std::shared_ptr<const Model> model, Configuration all, std::vector<Index> islands);

  std::shared_ptr<const Model> model;  ///< of all bodies
  Configuration configuration;         ///< of all; of those that are awake, as it was once
  std::vector<Index> islands;          ///< by body; kAwake where it is stepped
  RestingBodies resting;               ///< those that sleep
};

/// Bodies that are still sleep where nothing is stepped, each by itself, and nowhere else.
void settle_still_bodies(const Model& model, const Configuration& at, std::vector<Index>& islands);

/// The model of those that are awake.
std::shared_ptr<const Model> compile_awake(const Model& model, const std::vector<Index>& islands);

/// Stops the bodies of islands, whose velocities become zero.
void stop(const Model& model, const std::vector<Index>& islands, Configuration& at);

}  // namespace vat
