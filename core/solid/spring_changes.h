#pragma once

#include "core/scene/scene.h"
#include "core/state/state.h"
#include "core/support/parallel.h"

namespace vat {

/// Returns the spring in its current state, with its plastic rest length. A torn spring has zero
/// stiffness and damping.
inline SpringEnd present_spring(const Model& model, const Configuration& at, Index end) {
  SpringEnd spring = model.spring_ends[end];
  if (at.springs.empty()) return spring;
  const SpringState& state = at.springs[end];
  spring.rest_length = state.rest_length;
  if (state.is_torn) spring.stiffness = spring.damping = 0;
  return spring;
}

/// Returns the rest length [m] after plastic flow of a spring over `dt` [s]. `rest` is the rest
/// length before the flow, `length` is the length after `dt`, and `start` is the rest length at
/// time 0. Springs with an initial rest length of 0 have no strain.
Real flown_length(const Plasticity& plasticity, Real start, Real rest, Real length, Real dt);

/// Applies plastic flow and tearing after a motion of `dt` [s]. Both ends of a spring store bitwise
/// equal values. Returns whether any spring has changed.
bool change_springs(const Model& model, TaskRunner* runner, Configuration& configuration, Real dt);

/// Returns the number of torn springs.
std::size_t count_torn(const Configuration& configuration);

}  // namespace vat
