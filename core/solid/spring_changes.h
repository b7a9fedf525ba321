#pragma once

#include "core/scene/scene.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// The spring as it is by now: flown springs have another rest length, torn ones no constants.
inline SpringEnd present_spring(const Model& model, const Configuration& at, Index end) {
  SpringEnd spring = model.spring_ends[end];
  if (at.springs.empty()) return spring;
  const SpringState& state = at.springs[end];
  spring.rest_length = state.rest_length;
  if (state.is_torn) spring.stiffness = spring.damping = 0;
  return spring;
}

/// The length at rest [m] to which a spring flows that is `length` long at the end of `dt`, from
/// `rest`; `start` is the length at rest at time 0. Springs of length 0 have no strain.
Real flown_length(const Plasticity& plasticity, Real start, Real rest, Real length, Real dt);

/// What the springs do that may flow or tear, after their ends have moved for `dt` to where they
/// are. Both ends of a spring come to the same bits. True where any changed.
bool change_springs(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);

/// How many springs are torn.
std::size_t count_torn(const Configuration& configuration);

}  // namespace vat
