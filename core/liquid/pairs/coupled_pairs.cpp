#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <limits>

#include "core/liquid/pairs/liquid_pairs.h"

namespace vat {

bool has_several_liquids(const Model& model) {
  const auto liquids = std::span(model.material).first(model.liquid_count);
  return std::ranges::any_of(liquids, [&](Index material) { return material != liquids[0]; });
}

bool has_central_viscosity(const Model& model) {
  return std::ranges::any_of(model.bodies, [&](const ModelBody& body) {
    return body.kind == BodyKind::liquid && model.liquids[body.material]->central_viscosity > 0;
  });
}

PairInputs pair_inputs(const StepContext& c) {
  PairInputs inputs = c.work.of<LiquidScratch>().sources.inputs();
  inputs.inverse_support = 1 / support_of(c.model);
  return inputs;
}

PairInputs force_inputs(const StepContext& c) {
  PairInputs inputs = pair_inputs(c);
  inputs.viscosity =
      c.model.liquids[c.model.material[0]]->central_viscosity * inputs.inverse_support;
  if (has_several_liquids(c.model)) {
    inputs.viscosities = c.work.of<LiquidScratch>().viscosities.data();
    inputs.target_viscosities = c.work.of<LiquidScratch>().target_viscosities.data();
  }
  return inputs;
}

PairInputs solid_force_inputs(const StepContext& c) {
  PairInputs inputs = force_inputs(c);
  inputs.first_target = c.work.of<LiquidScratch>().sources.first_solid();
  return inputs;
}

namespace {

constexpr PairViscosity kNone{0, 0, 1};

/// mu / h of liquid.
Real relative_viscosity(const StepContext& c, Index particle) {
  return liquid_of(c.model, particle).central_viscosity / support_of(c.model);
}

/// f(source) of each but the padding.
template <class F>
void set_viscosities(const StepContext& c, F&& f) {
  const std::size_t count = c.work.of<LiquidScratch>().sources.count();
  c.work.of<LiquidScratch>().viscosities.resize(count + 1);
  c.work.of<LiquidScratch>().viscosities[count] = kNone;
  for_blocks(c.runner, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      c.work.of<LiquidScratch>().viscosities[n] = f(static_cast<Index>(n));
  });
}

/// Of liquid towards liquid: mu_ij is 2 mu_i mu_j / (mu_i + mu_j), see mean_viscosity().
PairViscosity mean_of(Real mu) {
  // Not 0 over 0 between two without any.
  constexpr Real kLeast = static_cast<Real>(std::numeric_limits<float>::min());
  return {2 * mu, 1, std::max(mu, kLeast)};
}

void set_target_viscosities(const StepContext& c) {
  const std::span<const Index> order = c.work.of<LiquidScratch>().liquid.grid.order();
  c.work.of<LiquidScratch>().target_viscosities.resize(order.size());
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      c.work.of<LiquidScratch>().target_viscosities[s] = relative_viscosity(c, order[s]);
    }
  });
}

}  // namespace

void set_liquid_viscosities(const StepContext& c) {
  constexpr PairViscosity kOfTarget{1, 0, 1};
  const PairSources& sources = c.work.of<LiquidScratch>().sources;
  const std::span<const Index> order = c.work.of<LiquidScratch>().liquid.grid.order();
  set_viscosities(c, [&](Index n) {
    if (n >= sources.first_mirrored()) return kNone;
    const Index source = sources.source_of(n);
    return source < sources.first_solid() ? mean_of(relative_viscosity(c, order[source]))
                                          : kOfTarget;
  });
  set_target_viscosities(c);
}

void set_solid_viscosities(const StepContext& c) {
  const PairSources& sources = c.work.of<LiquidScratch>().sources;
  const std::span<const Index> order = c.work.of<LiquidScratch>().liquid.grid.order();
  set_viscosities(c, [&](Index n) {
    if (n >= sources.first_mirrored()) return kNone;
    const Index source = sources.source_of(n);
    if (source >= sources.first_solid()) return kNone;
    return PairViscosity{relative_viscosity(c, order[source]), 0, 1};
  });
  c.work.of<LiquidScratch>().target_viscosities.assign(
      c.work.of<LiquidScratch>().solids_in_liquid.grid.order().size(), 1);
}

void set_image_viscosities(const StepContext& c) {
  const PairSources& sources = c.work.of<LiquidScratch>().sources;
  const std::span<const Index> order = c.work.of<LiquidScratch>().liquid.grid.order();
  set_viscosities(c, [&](Index n) {
    if (n < sources.first_mirrored_liquid()) return kNone;
    return mean_of(relative_viscosity(c, order[sources.source_of(n)]));
  });
  set_target_viscosities(c);
}

void set_slope_weights(const StepContext& c) {
  const Model& model = c.model;
  if (!has_several_liquids(model)) return;
  const Real first = slope_factor(model, *model.liquids[model.material[0]]);
  WeightFactors factors;
  factors.liquid = by_material(
      model, [&](const LiquidModel& liquid) { return slope_factor(model, liquid) / first; });
  c.work.of<LiquidScratch>().sources.set_weights(c, factors);
}

ImageMotion::ImageMotion(const StepContext& c)
    : c_(c),
      motion_(vat::motion_of(c)),
      pressure_(c.model, motion_, Vec3::Zero()),
      is_same_liquid_(!has_several_liquids(c.model)) {}

PairMotion ImageMotion::operator()(const PairImage& image, const PairMotion& source) const {
  const Vec3 velocity = image.turn({source.vx, source.vy, source.vz});
  const bool is_mirrored = image.axes[0] || image.axes[1] || image.axes[2];
  // Where there is no pressure, the weight beyond a wall adds none.
  const bool is_free = !c_.model.is_filled && source.pressure <= 0;
  if (!is_mirrored || is_free) return vat::motion_of(source.pressure, velocity);
  const Vec3 position = c_.work.of<LiquidScratch>().sources.place(image.source);
  const bool is_first =
      is_same_liquid_ || image.source >= c_.work.of<LiquidScratch>().sources.first_solid();
  const LiquidModel& liquid = liquid_of(
      c_.model, is_first ? 0 : c_.work.of<LiquidScratch>().liquid.grid.order()[image.source]);
  if (!c_.model.scene.central_field) {
    Vec3 way = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const bool turns = image.axes[static_cast<std::size_t>(axis)];
      way[axis] = turns ? (image.offset[axis] - position[axis]) - position[axis] : 0;
    }
    return vat::motion_of(pressure_.near(liquid, source.pressure, way), velocity);
  }
  const Mirror mirror = image.mirror();
  const ImagePressure pressure(c_.model, motion_, mirror.place(position));
  return vat::motion_of(pressure(liquid, source.pressure, position, mirror), velocity);
}

}  // namespace vat
