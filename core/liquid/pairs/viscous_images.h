#pragma once

#include <array>
#include <vector>

#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

struct ForceModel;

/// Stage: adds the viscosity between liquids and mirror walls (Model::is_coupled). In a no-slip
/// wall, an image has the reversed velocity of its particle, so that the velocity is zero midway
/// (J. P. Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214, sec. 3.5). In a slip wall it
/// has the mirrored velocity, which resists compression against the wall. The force is the liquid's
/// viscous force without the terms that couple two axes. These terms cancel between the images on
/// both sides; without them, the force is symmetric in two particles and never adds energy.
///
/// Slip walls take part if a liquid's viscosity exceeds its artificial viscosity, which is meant
/// for sound, not for walls.
void add_viscous_image_forces(StepContext& context);

/// The viscous forces of images as a symmetric, negative semi-definite matrix D; see DampingMatrix.
class ViscousImages {
 public:
  void collect(const ForceModel& force_model, Real time);
  /// force += D w, with an entry for each particle.
  void add(const ForceModel& force_model, const std::vector<Vec3>& w,
           std::vector<Vec3>& force) const;

 private:
  /// f = -strength (w - factor w_other), axis by axis.
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
