#pragma once

#include <array>
#include <vector>

#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

struct ForceModel;

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

/// The viscous forces of images as a symmetric, negative semi-definite matrix D; see DampingMatrix.
class ViscousImages {
 public:
  void collect(const ForceModel& force_model, Real time);
  /// Adds D w to `force`. Both vectors have an element for each particle.
  void add(const ForceModel& force_model, const std::vector<Vec3>& w,
           std::vector<Vec3>& force) const;

 private:
  /// An image with the force -strength (w - factor w_other) on its particle, for each axis.
  struct Image {
    Index other;    ///< particle
    Vec3 strength;  ///< [N s/m]
    Vec3 factor;    ///< 1 or -1
  };
  struct Block {
    std::vector<Image> images;
    std::array<Index, kBlockSize + 1> begin;  ///< by slot
  };
  std::vector<Block> blocks_;
};

}  // namespace vat
