#pragma once

#include <vector>

#include "core/numerics/step_limits.h"

namespace vat {

/// Adds the parts of find_oscillating_parts() that result from contacts.
void add_contact_limits(const Scene& scene, std::span<const SampledBody* const> samples,
                        std::vector<OscillatingPart>& parts);

/// Returns the maximum number of particles of a body that can touch a plane simultaneously. Tested
/// normals are the axes of the body, their diagonals and the principal axes. A particle counts if
/// it is within a tenth of a radius of the foremost particle.
std::size_t count_flattest_side(const SampledBody& body, const Quat& orientation);

}  // namespace vat
