#pragma once

#include "core/liquid/pairs/pair_sources.h"
#include "core/liquid/pairs/scratch.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/stage/context.h"
#include "core/state/state.h"

/// Functions for sums over the pairs of coupled liquids; see core/liquid/pairs/pair_sums.h. Coupled
/// liquids interact with solids and walls by SPH (Model::is_coupled).
namespace vat {

/// Returns the kernel whose scale is a factor of the weights of sources.
inline const SmoothingKernel& reference_kernel(const Model& model) {
  return model.liquids[model.material[0]]->kernel;
}

/// Returns the ratio of the relative density s of a liquid to the sum PairSums::density.
inline Real scale_factor(const Model& model, const LiquidModel& liquid) {
  return liquid.kernel.scale() / reference_kernel(model).scale();
}

/// Returns the ratio of sums with G dW/dx to sums with g x (see PairSums), with the liquid's
/// slope_scale G.
inline Real slope_factor(const Model& model, const LiquidModel& liquid) {
  return liquid.slope_scale * liquid.support_radius * liquid.kernel.slope_scale() /
         reference_kernel(model).scale();
}

/// Values by material: by_material() returns f(liquid) for each liquid, and 0 for other materials.
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

/// Returns whether a liquid has physical or artificial viscosity.
bool has_central_viscosity(const Model& model);

/// Returns the inputs of sums that depend on positions only.
PairInputs pair_inputs(const StepContext& context);
/// Returns these inputs with the charges of the sources in place of their weights.
PairInputs charged_pair_inputs(const StepContext& context);

/// Return the inputs of sums that also depend on motions, with liquid or solids as targets.
PairInputs force_inputs(const StepContext& context);
/// The same with PairInputs::first_dragging.
PairInputs dragging_force_inputs(const StepContext& context);
PairInputs solid_force_inputs(const StepContext& context);

/// Set LiquidScratch::viscosities and target_viscosities for liquid or solids as targets. A pair of
/// liquid and solid has the viscosity of the liquid.
void set_liquid_viscosities(const StepContext& context);
void set_solid_viscosities(const StepContext& context);
/// Sets LiquidScratch::viscosities and target_viscosities with images of liquid as the only
/// sources.
void set_image_viscosities(const StepContext& context);

/// Sets the weights of sources so that slope_factor() of the first liquid is valid for all liquids.
void set_slope_weights(const StepContext& context);

inline PairMotion motion_of(Real pressure, const Vec3& velocity) {
  return {pressure, velocity.x(), velocity.y(), velocity.z()};
}

/// Computes the motion (pressure and velocity) of an image of a particle, in walls or in a periodic
/// world. Images in walls have the pressure of ImagePressure.
class ImageMotion {
 public:
  explicit ImageMotion(const StepContext& c);
  PairMotion operator()(const PairImage& image, const PairMotion& source) const {
    const Vec3 velocity = image.turn({source.vx, source.vy, source.vz});
    const bool is_mirrored = image.axes[0] || image.axes[1] || image.axes[2];
    // Without pressure, the weight of liquid beyond a wall adds no pressure.
    const bool is_free = !c_.model.is_filled && source.pressure <= 0;
    return motion_of(!is_mirrored || is_free ? source.pressure : pressure(image, source.pressure),
                     velocity);
  }

 private:
  Real pressure(const PairImage& image, Real source_pressure) const;

  const StepContext& c_;
  const LiquidScratch& buffers_;
  const VatMotion motion_;
  const ImagePressure pressure_;    ///< uniform without a central field
  const LiquidModel* same_liquid_;  ///< of all particles; null if liquids differ
  const bool has_central_field_;
};

}  // namespace vat
