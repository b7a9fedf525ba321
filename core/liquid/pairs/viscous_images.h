#pragma once

#include <array>
#include <vector>

#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

struct ForceModel;

/// Stage: viscosity between liquids and walls that are mirrors (Model::is_coupled). Seen from a
/// no-slip wall, an image has its particle's velocity turned round, so that it is zero in the
/// middle (J. P. Morris, P. J. Fox, Y. Zhu, J. Comput. Phys. 136 (1997) 214, sec. 3.5); from a slip
/// one, as mirrored, which resists what presses against the wall. Particles and images have the
/// liquid's own viscous force, but for what couples two axes in it: that cancels between images on
/// both sides, and without it the force is symmetric in any two particles and never adds energy.
///
/// Slip walls take part where a liquid is thicker than its artificial viscosity is, which is for
/// sound and not for walls.
void add_viscous_image_forces(StepContext& context);

/// The same as a symmetric, negative semi-definite matrix D; see DampingMatrix.
class ViscousImages {
 public:
  void collect(const ForceModel& force_model, Real time);
  /// force += D w, both with an entry for each particle.
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
