#include "core/stepping/local_levels.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {
namespace {

std::uint8_t small_level_of(Real step, Real dt) {
  return static_cast<std::uint8_t>(level_of(step, dt));
}

/// Raises the levels of free particles as their neighbours require. Returns whether it raised one.
bool raise_neighbours(const Model& model, std::vector<std::uint8_t>& level) {
  bool raised = false;
  for (Index i = model.liquid_count; i < model.free_count; ++i) {
    if (model.inverse_mass[i] == 0) continue;
    int least = level[i];
    for (Index s = model.spring_begin[i]; s < model.spring_begin[i + 1]; ++s) {
      least = std::max(least, level[model.spring_ends[s].other] - kMaxLevelDifference);
    }
    raised = raised || least > level[i];
    level[i] = static_cast<std::uint8_t>(least);
  }
  return raised;
}

}  // namespace

void choose_local_levels(const Model& model, const PresentSteps& steps, Real dt,
                         LocalLevels& levels) {
  VAT_CHECK(steps.particle.size() == model.free_count &&
            steps.rigid.size() == model.rigid_bodies.size());
  levels.particle.resize(model.particle_count);
  const Index coupled = model.is_coupled ? model.liquid_count : 0;
  std::fill_n(levels.particle.begin(), coupled, std::uint8_t{0});
  for (Index i = coupled; i < model.free_count; ++i) {
    levels.particle[i] = model.inverse_mass[i] == 0 ? 0 : small_level_of(steps.particle[i], dt);
  }
  for (std::size_t b = 0; b < model.rigid_bodies.size(); ++b) {
    const RigidModel& rigid = model.rigid_bodies[b];
    const bool is_moved = rigid.inverse_mass > 0 || rigid.axle;
    const std::uint8_t level = !is_moved ? 0 : small_level_of(steps.rigid[b], dt);
    std::fill(levels.particle.begin() + rigid.particles.begin,
              levels.particle.begin() + rigid.particles.end, level);
  }
  levels.liquid = model.liquid_count > coupled ? small_level_of(steps.liquid, dt) : 0;
  if (model.spring_ends.empty()) return;
  const auto [coarsest, finest] = std::ranges::minmax(levels.particle);
  if (finest - coarsest <= kMaxLevelDifference) return;
  while (raise_neighbours(model, levels.particle)) {
  }
}

std::string describe_sub_steps(const Model& model) {
  const Numerics& numerics = model.scene.numerics;
  if (numerics.control != StepControl::local) return {};
  const StepBounds bounds = find_step_bounds(model);
  std::string text;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const ModelBody& body = model.bodies[b];
    if (body.kind == BodyKind::liquid) continue;
    std::uint32_t level = level_of(numerics.step / model.scene.bodies[b].sub_steps, numerics.step);
    for (Index i = body.particles.begin; i < std::min(body.particles.end, model.free_count); ++i) {
      level = std::max(level, level_of(bounds.own_step[i], numerics.step));
    }
    text += "sub-steps of " + body.name + ": " + std::to_string(1U << level) + '\n';
  }
  return text;
}

}  // namespace vat
