#pragma once

#include <span>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// The expected cost of a scene, within a factor of two or three. It assumes one core of a current
/// processor, steps of the nominal length, and no contacts between bodies.
struct CostEstimate {
  Real memory = 0;   ///< [bytes]
  Real seconds = 0;  ///< of one core, for one simulated second
};

/// `samples` are the scene's bodies.
CostEstimate estimate_cost(const Scene& scene, std::span<const SampledBody* const> samples);

}  // namespace vat
