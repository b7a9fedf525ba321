#pragma once

#include <span>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// What a scene is likely to need, to a factor of two or three: for one core of a present-day
/// processor, steps of the nominal length, and without contacts between bodies.
struct CostEstimate {
  Real memory = 0;   ///< [bytes]
  Real seconds = 0;  ///< of a core for a simulated second
};

/// `samples` are the scene's bodies.
CostEstimate estimate_cost(const Scene& scene, std::span<const SampledBody* const> samples);

}  // namespace vat
