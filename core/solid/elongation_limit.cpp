#include "core/solid/elongation_limit.h"

#include <atomic>

#include "core/support/check.h"

namespace vat {
namespace {

/// Limits one spring. Returns whether its elongation was to exceed the tolerance.
bool limit_spring(const Model& model, const LimitedSpring& spring, Real dt, Configuration& at) {
  const bool is_torn = !at.springs.empty() && at.springs[spring.end].is_torn;
  const Vec3 x = at.position[spring.a] - at.position[spring.b];
  const Real length = x.norm();
  if (is_torn || length == 0) return false;
  const Vec3 n = x / length;
  const Real speed = (at.velocity[spring.a] - at.velocity[spring.b]).dot(n);
  const Real excess = speed - (spring.greatest - length) / dt;
  if (!(excess > 0)) return false;
  const Real mobility_a = model.inverse_mass[spring.a];
  const Real mobility_b = model.inverse_mass[spring.b];
  const Vec3 impulse = (excess / (mobility_a + mobility_b)) * n;
  at.velocity[spring.a] -= mobility_a * impulse;
  at.velocity[spring.b] += mobility_b * impulse;
  return excess * dt > kElongationTolerance * spring.greatest;
}

}  // namespace

void limit_elongation(const Model& model, TaskRunner* runner, Configuration& at, Real dt) {
  if (model.limited_springs.empty()) return;
  VAT_CHECK(dt > 0 && at.velocity.size() == model.particle_count);
  for (int sweep = 0; sweep < kElongationSweeps; ++sweep) {
    std::atomic<bool> any = false;
    for (std::size_t colour = 0; colour + 1 < model.limited_begin.size(); ++colour) {
      const Index first = model.limited_begin[colour];
      for_blocks(runner, model.limited_begin[colour + 1] - first,
                 [&](std::size_t begin, std::size_t end) {
                   bool own = false;
                   for (std::size_t k = begin; k < end; ++k) {
                     const LimitedSpring& spring = model.limited_springs[first + k];
                     own = limit_spring(model, spring, dt, at) || own;
                   }
                   if (own) any = true;
                 });
    }
    if (!any) return;
  }
}

}  // namespace vat
