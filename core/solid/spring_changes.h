#pragma once

#include "core/scene/scene.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Returns the spring in its present state: with its plastic rest length, and with zero constants
/// if it is torn.
inline SpringEnd present_spring(const Model& model, const Configuration& at, Index end) {
  SpringEnd spring = model.spring_ends[end];
  if (at.springs.empty()) return spring;
  const SpringState& state = at.springs[end];
  spring.rest_length = state.rest_length;
  if (state.is_torn) spring.stiffness = spring.damping = 0;
  return spring;
}

/// The rest length [m] after plastic flow of a spring with the rest length `rest` and the length
/// `length` at the end of `dt`. `start` is the rest length at time 0. Springs of rest length 0 have
/// no strain.
Real flown_length(const Plasticity& plasticity, Real start, Real rest, Real length, Real dt);

/// Applies plastic flow and tearing after a motion of `dt`. Both ends of a spring get the same
/// bits. Returns whether a spring has changed.
bool change_springs(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);

/// The number of torn springs.
std::size_t count_torn(const Configuration& configuration);

}  // namespace vat
