#pragma once

#include <vector>

#include "core/scene/step_limits.h"

namespace vat {

/// The part of find_step_limits() that contacts set.
std::vector<StepLimit> find_contact_limits(const Scene& scene,
                                           const std::vector<SampledBody>& samples);

/// How many of the body's particles can touch a plane at once: those within a tenth of a radius of
/// the foremost, along the body's axes, their diagonals and its principal axes.
std::size_t count_flattest_side(const SampledBody& body, const Quat& orientation);

}  // namespace vat
