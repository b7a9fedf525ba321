#pragma once

#include <vector>

#include "core/numerics/step_limits.h"

namespace vat {

/// Adds the parts of find_oscillating_parts() that are due to contacts.
void add_contact_limits(const Scene& scene, std::span<const SampledBody* const> samples,
                        std::vector<OscillatingPart>& parts);

/// The number of particles of a body that can touch a plane at once. Tested directions are the
/// body's axes, their diagonals and the principal axes. Particles within a tenth of a radius of the
/// foremost one count.
std::size_t count_flattest_side(const SampledBody& body, const Quat& orientation);

}  // namespace vat
