#pragma once

#include "core/liquid/pairs/pair_sources.h"
#include "core/liquid/pairs/scratch.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/stage/context.h"
#include "core/state/state.h"

/// Sums over the pairs of coupled liquids, by core/pairs.
namespace vat {

/// The kernel whose scale the weights of sources have.
inline const SmoothingKernel& reference_kernel(const Model& model) {
  return model.liquids[model.material[0]]->kernel;
}

/// What PairSums::density is multiplied by to be s of a liquid.
inline Real scale_factor(const Model& model, const LiquidModel& liquid) {
  return liquid.kernel.scale() / reference_kernel(model).scale();
}

/// What sums along g x are multiplied by to be sums along G dW/dx, with G the liquid's slope_scale.
inline Real slope_factor(const Model& model, const LiquidModel& liquid) {
  return liquid.slope_scale * liquid.support_radius * liquid.kernel.slope_scale() /
         reference_kernel(model).scale();
}

/// f(liquid) of each material, 0 of those without.
using ByMaterial = std::array<Real, kMaxMaterials>;
template <class F>
ByMaterial by_material(const Model& model, F&& f) {
  ByMaterial values{};
  for (std::size_t m = 0; m < model.liquids.size(); ++m) {
    if (model.liquids[m]) values[m] = f(*model.liquids[m]);
  }
  return values;
}

inline const PairSums& pair_sums_of(const StepContext& c) {
  return pair_sums(c.work.instructions, c.work.of<LiquidScratch>().sources.precision(),
                   reference_kernel(c.model).id());
}

/// Whether two materials among the liquid particles differ.
bool has_several_liquids(const Model& model);

/// Whether pairs of some liquid rub: by its viscosity or the artificial one.
bool has_central_viscosity(const Model& model);

/// For sums over places alone.
PairInputs pair_inputs(const StepContext& context);

/// For sums with motions, the targets liquid, or solids.
PairInputs force_inputs(const StepContext& context);
PairInputs solid_force_inputs(const StepContext& context);

/// The columns of the workspace, for liquid as the targets; and for solids, to which pairs are as
/// viscous as the liquid.
void set_liquid_viscosities(const StepContext& context);
void set_solid_viscosities(const StepContext& context);
/// The same for images of liquid as the only sources.
void set_image_viscosities(const StepContext& context);

/// Gives each liquid's sources the weight with which slope_factor() of the first is its own.
void set_slope_weights(const StepContext& context);

inline PairMotion motion_of(Real pressure, const Vec3& velocity) {
  return {pressure, velocity.x(), velocity.y(), velocity.z()};
}

/// The motion of an image in walls, with the pressure of ImagePressure, or in a world that repeats
/// itself.
class ImageMotion {
 public:
  explicit ImageMotion(const StepContext& c);
  PairMotion operator()(const PairImage& image, const PairMotion& source) const;

 private:
  const StepContext& c_;
  const VatMotion motion_;
  const ImagePressure pressure_;  ///< the same everywhere but in a central field
  const bool is_same_liquid_;     ///< all liquid
};

}  // namespace vat
