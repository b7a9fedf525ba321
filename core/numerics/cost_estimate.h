#pragma once

#include <span>

#include "core/sampling/sampling.h"
#include "core/scene/scene.h"

namespace vat {

/// Expected cost of a scene, accurate to a factor of two or three. The estimate assumes one core of
/// a current processor, steps of the nominal length, and no contacts between bodies.
struct CostEstimate {
  Real memory = 0;   ///< [bytes]
  Real seconds = 0;  ///< time on one core per simulated second
};

/// Returns the cost estimate of `scene`. `samples` are the bodies of the scene.
CostEstimate estimate_cost(const Scene& scene, std::span<const SampledBody* const> samples);

}  // namespace vat
