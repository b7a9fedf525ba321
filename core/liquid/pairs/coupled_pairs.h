#pragma once

#include "core/liquid/pairs/pair_sources.h"
#include "core/liquid/pairs/scratch.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/stage/context.h"
#include "core/state/state.h"

/// Sums over the pairs of coupled liquids; see core/liquid/pairs/pair_sums.h.
namespace vat {

/// The kernel whose scale is included in the weights of sources.
inline const SmoothingKernel& reference_kernel(const Model& model) {
  return model.liquids[model.material[0]]->kernel;
}

/// The factor from PairSums::density to the relative density s of a liquid.
inline Real scale_factor(const Model& model, const LiquidModel& liquid) {
  return liquid.kernel.scale() / reference_kernel(model).scale();
}

/// The factor from sums along g x to sums along G dW/dx, with the liquid's slope_scale G.
inline Real slope_factor(const Model& model, const LiquidModel& liquid) {
  return liquid.slope_scale * liquid.support_radius * liquid.kernel.slope_scale() /
         reference_kernel(model).scale();
}

/// f(liquid) of each material; 0 for other materials.
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

/// Returns whether the liquid particles have several materials.
bool has_several_liquids(const Model& model);

/// Returns whether some liquid has viscosity, physical or artificial.
bool has_central_viscosity(const Model& model);

/// Inputs of sums that depend on positions only.
PairInputs pair_inputs(const StepContext& context);

/// Inputs of sums with motions, with liquid or solids as targets.
PairInputs force_inputs(const StepContext& context);
PairInputs solid_force_inputs(const StepContext& context);

/// Set the columns of viscosities for liquid or solids as targets. For solids, pairs have the
/// viscosity of the liquid.
void set_liquid_viscosities(const StepContext& context);
void set_solid_viscosities(const StepContext& context);
/// Sets the columns of viscosities with images of liquid as the only sources.
void set_image_viscosities(const StepContext& context);

/// Sets the weights of sources so that slope_factor() of the first liquid holds for all liquids.
void set_slope_weights(const StepContext& context);

inline PairMotion motion_of(Real pressure, const Vec3& velocity) {
  return {pressure, velocity.x(), velocity.y(), velocity.z()};
}

/// The motion of an image in walls, with the pressure of ImagePressure, or of an image in a
/// periodic world.
class ImageMotion {
 public:
  explicit ImageMotion(const StepContext& c);
  PairMotion operator()(const PairImage& image, const PairMotion& source) const;

 private:
  const StepContext& c_;
  const VatMotion motion_;
  const ImagePressure pressure_;  ///< uniform without a central field
  const bool is_same_liquid_;     ///< all liquid has one material
};

}  // namespace vat
