#include "core/solid/spring_changes.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/support/check.h"

namespace vat {
namespace {

/// Changes one spring of the material. Returns whether it changed.
bool change_spring(const Material& material, Real start, Real length, Real dt, SpringState& state) {
  if (state.is_torn || start == 0) return false;
  if (material.tearing_strain && length > (1 + *material.tearing_strain) * start) {
    state.is_torn = true;
    return true;
  }
  if (!material.plasticity) return false;
  const Real rest = flown_length(*material.plasticity, start, state.rest_length, length, dt);
  const bool has_flown = rest != state.rest_length;
  state.rest_length = rest;
  return has_flown;
}

}  // namespace

Real flown_length(const Plasticity& plasticity, Real start, Real rest, Real length, Real dt) {
  if (start == 0) return rest;
  const Real flown = rest / start - 1;
  const Real stress = (length - rest) / start - plasticity.hardening * flown;
  const Real excess = std::abs(stress) - plasticity.yield_strain;
  if (!(excess > 0)) return rest;
  const Real share =
      plasticity.relaxation_time > 0 ? -std::expm1(-dt / plasticity.relaxation_time) : 1;
  const Real flow = std::copysign(share * excess / (1 + plasticity.hardening), stress);
  const Real most = plasticity.max_strain;
  return start * (1 + std::clamp(flown + flow, -most, most));
}

bool change_springs(const Model& model, TaskRunner* runner, Configuration& at, Real dt) {
  if (at.springs.empty()) return false;
  VAT_CHECK(at.springs.size() == model.spring_ends.size());
  std::atomic<bool> any = false;
  const Index first = model.liquid_count;
  for_blocks(runner, model.free_count - first, [&](std::size_t begin, std::size_t end) {
    bool own = false;
    for (std::size_t k = begin; k < end; ++k) {
      const Index i = first + static_cast<Index>(k);
      const Material& material = model.scene.materials[model.material[i]];
      if (!material.plasticity && !material.tearing_strain) continue;
      for (Index s = model.spring_begin[i]; s < model.spring_begin[i + 1]; ++s) {
        const SpringEnd& spring = model.spring_ends[s];
        const Real length = (at.position[i] - at.position[spring.other]).norm();
        own = change_spring(material, spring.rest_length, length, dt, at.springs[s]) || own;
      }
    }
    if (own) any = true;
  });
  return any;
}

std::size_t count_torn(const Configuration& at) {
  return static_cast<std::size_t>(std::ranges::count(at.springs, true, &SpringState::is_torn)) / 2;
}

}  // namespace vat
