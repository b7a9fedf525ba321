#pragma once

#include <array>
#include <vector>

#include "core/laws/vat_motion.h"
#include "core/liquid/pairs/pair_sources.h"
#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

/// Stage that adds the viscous forces between liquids and their images in walls (see
/// Model::is_coupled). At a no-slip wall, an image has the reversed velocity of its particle, so
/// that the velocity midway is zero (J. P. Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997)
/// 214, sec. 3.5). At a slip wall, an image has the mirrored velocity, so that the viscous force
/// resists compression against the wall. The force is the liquid's viscous force without the terms
/// that couple two axes. The contributions of the images on opposite sides of a particle to these
/// terms cancel. Without the terms, the force is symmetric in the two particles and never adds
/// energy.
///
/// Slip walls have viscous forces only if a liquid's viscosity exceeds its artificial viscosity,
/// whose purpose is the damping of sound.
void add_viscous_image_forces(StepContext& context);

/// Adds these forces for the given velocities of the particles to `force`. The liquid slots of
/// LiquidScratch::sources must have these velocities. If `walls_move` is false, all walls are at
/// rest.
void add_viscous_image_forces(const StepContext& context, const std::vector<Vec3>& velocities,
                              bool walls_move, std::vector<Vec3>& force);

/// Returns whether PairSums::force can include these forces with PairInputs::first_dragging. All
/// images must take part: images in slip walls only do if the liquid's viscosity exceeds its
/// artificial viscosity. All liquids must be the same material.
bool is_dragged_by_all_images(const Model& model);

/// The velocities of images in walls, as functions of the velocity of the source.
class ImageVelocities {
 public:
  ImageVelocities() = default;
  /// If `walls_move` is false, the walls are at rest.
  ImageVelocities(const Vat& vat, const VatMotion& motion, bool walls_move);

  Vec3 operator()(const PairImage& image, const Vec3& velocity) const {
    const MirroredVelocity& mirrored = all_[image.walls];
    return mirrored.factor.cwiseProduct(velocity) + mirrored.shift;
  }
  /// Returns whether a wall of the image is a no-slip wall.
  bool is_dragged(const PairImage& image) const { return all_[image.walls].is_dragged; }

 private:
  /// The mirrored velocity: v -> factor v + shift, axis by axis.
  struct MirroredVelocity {
    bool is_dragged = false;  ///< at least one of its walls is no_slip
    Vec3 factor = Vec3::Ones();
    Vec3 shift = Vec3::Zero();
  };
  static MirroredVelocity velocity_of(const Vat& vat, const VatMotion& motion, bool walls_move,
                                      std::size_t index);

  std::array<MirroredVelocity, 27> all_;  ///< by PairImage::walls
};

}  // namespace vat
