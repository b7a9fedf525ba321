#include "core/liquid/pairs/coupled_pairs.h"
#include "core/liquid/pairs/scratch.h"

#include <algorithm>
#include <limits>

#include "core/liquid/pairs/liquid_pairs.h"
#include "core/support/check.h"

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

namespace {

PairInputs in_supports(const StepContext& c, PairInputs inputs) {
  VAT_CHECK(c.model.liquid_count > 0);
  inputs.inverse_support = 1 / support_of(c.model);
  return inputs;
}

}  // namespace

PairInputs pair_inputs(const StepContext& c) {
  return in_supports(c, c.work.of<LiquidScratch>().sources.inputs());
}

PairInputs charged_pair_inputs(const StepContext& c) {
  return in_supports(c, c.work.of<LiquidScratch>().sources.charged_inputs());
}

PairInputs force_inputs(const StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  PairInputs inputs = pair_inputs(c);
  inputs.viscosity =
      c.model.liquids[c.model.material[0]]->central_viscosity * inputs.inverse_support;
  if (has_several_liquids(c.model)) {
    inputs.viscosities = buffers.viscosities.data();
    inputs.target_viscosities = buffers.target_viscosities.data();
  }
  return inputs;
}

PairInputs dragging_force_inputs(const StepContext& c) {
  PairInputs inputs = force_inputs(c);
  inputs.first_dragging = c.work.of<LiquidScratch>().sources.first_mirrored_liquid();
  return inputs;
}

PairInputs solid_force_inputs(const StepContext& c) {
  PairInputs inputs = force_inputs(c);
  inputs.first_target = c.work.of<LiquidScratch>().sources.first_solid();
  return inputs;
}

namespace {

constexpr PairViscosity kNone{0, 0, 1};

/// mu / h of a liquid particle.
Real relative_viscosity(const StepContext& c, Index particle) {
  return liquid_of(c.model, particle).central_viscosity / support_of(c.model);
}

/// Sets the viscosity of each source to f(source), and that of the padding to 0.
template <class F>
void set_viscosities(const StepContext& c, F&& f) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const std::size_t count = buffers.sources.count();
  buffers.viscosities.resize(count + 1);
  buffers.viscosities[count] = kNone;
  for_blocks(c.runner, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) buffers.viscosities[n] = f(static_cast<Index>(n));
  });
}

/// Between liquids, mu_ij is 2 mu_i mu_j / (mu_i + mu_j). With this mean, both liquids have the
/// same shear stress at their interface (J. P. Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136
/// (1997) 214, eq. 22).
PairViscosity mean_of(Real mu) {
  // Avoids 0 / 0 between two inviscid liquids.
  constexpr Real kLeast = static_cast<Real>(std::numeric_limits<float>::min());
  return {2 * mu, 1, std::max(mu, kLeast)};
}

void set_target_viscosities(const StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const std::span<const Index> order = buffers.liquid.grid.order();
  buffers.target_viscosities.resize(order.size());
  for_blocks(c.runner, order.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      buffers.target_viscosities[s] = relative_viscosity(c, order[s]);
    }
  });
}

}  // namespace

void set_liquid_viscosities(const StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  constexpr PairViscosity kOfTarget{1, 0, 1};
  const PairSources& sources = buffers.sources;
  const std::span<const Index> order = buffers.liquid.grid.order();
  set_viscosities(c, [&](Index n) {
    if (n >= sources.first_mirrored()) return kNone;
    const Index source = sources.source_of(n);
    return source < sources.first_solid() ? mean_of(relative_viscosity(c, order[source]))
                                          : kOfTarget;
  });
  set_target_viscosities(c);
}

void set_solid_viscosities(const StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const PairSources& sources = buffers.sources;
  const std::span<const Index> order = buffers.liquid.grid.order();
  set_viscosities(c, [&](Index n) {
    if (n >= sources.first_mirrored()) return kNone;
    const Index source = sources.source_of(n);
    if (source >= sources.first_solid()) return kNone;
    return PairViscosity{relative_viscosity(c, order[source]), 0, 1};
  });
  buffers.target_viscosities.assign(buffers.solids_in_liquid.grid.order().size(), 1);
}

void set_image_viscosities(const StepContext& c) {
  LiquidScratch& buffers = c.work.of<LiquidScratch>();
  const PairSources& sources = buffers.sources;
  const std::span<const Index> order = buffers.liquid.grid.order();
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
      buffers_(c.work.of<LiquidScratch>()),
      motion_(vat::motion_of(c)),
      pressure_(c.model, motion_, Vec3::Zero()),
      same_liquid_(has_several_liquids(c.model) ? nullptr : &liquid_of(c.model, 0)),
      has_central_field_(c.model.scene.central_field.has_value()) {}

Real ImageMotion::pressure(const PairImage& image, Real source_pressure) const {
  const PairSources& sources = buffers_.sources;
  const Vec3 position = sources.place(image.source);
  const bool is_liquid = image.source < sources.first_solid();
  const LiquidModel& liquid =
      same_liquid_ != nullptr
          ? *same_liquid_
          : liquid_of(c_.model, is_liquid ? buffers_.liquid.grid.order()[image.source] : 0);
  if (!has_central_field_) {
    Vec3 way = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const bool turns = image.axes[static_cast<std::size_t>(axis)];
      way[axis] = turns ? (image.offset[axis] - position[axis]) - position[axis] : 0;
    }
    return pressure_.near(liquid, source_pressure, way);
  }
  const Mirror mirror = image.mirror();
  const ImagePressure pressure(c_.model, motion_, mirror.place(position));
  return pressure(liquid, source_pressure, position, mirror);
}

}  // namespace vat
