#pragma once

#include <chrono>
#include <functional>
#include <span>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/instruction_set.h"
#include "core/support/parallel.h"

namespace vat {

/// Duration of the run of measure_cost().
inline constexpr std::chrono::milliseconds kMeasuringTime{200};

/// Returns the cost of a valid scene [s per simulated second]: that of the median step from the
/// start of the scene until kMeasuringTime has passed, on all threads of `runner`.
Real measure_cost(const Scene& scene, TaskRunner* runner, InstructionSet instructions);

/// Returns the expected simulated seconds per second of valid scenes that differ in their levels.
/// `measure` returns the cost [s] of the first scene, with its contacts. The costs of the others
/// follow from this and from the ratios of the cost estimates.
std::vector<Real> real_time_factors(std::span<const Scene> levels,
                                    const std::function<Real(const Scene&)>& measure);

}  // namespace vat
