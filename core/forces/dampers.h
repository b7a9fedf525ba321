#pragma once

#include <vector>

#include "core/step/workspace.h"

namespace vat {

struct ForceModel;

/// What dampers see of two particles, or of one and a wall: f_i = -strength ((w_i - w_j).n) n.
struct Damper {
  Index other;     ///< kNoParticle: a wall
  Real strength;   ///< [N s/m]
  Vec3 direction;  ///< n
};
inline constexpr Index kNoParticle = ~Index{0};

/// Dampers of one block of particles: those of the block's k-th are [begin[k], begin[k + 1]).
struct DamperBlock {
  std::vector<Damper> dampers;
  std::array<Index, kBlockSize + 1> begin;
};

/// All forces that depend on velocities, but users' grabs, at one configuration, as a symmetric,
/// negative semi-definite matrix D: when velocities change by w, forces change by D w. Contacts
/// that do not push are left out.
class DampingMatrix {
 public:
  /// Of the configuration that `force_model` was last evaluated at, with its velocities.
  void collect(const ForceModel& force_model, const Configuration& at, Real time);

  /// force = D w, both with an entry for each particle.
  void multiply(const ForceModel& force_model, const std::vector<Vec3>& w,
                std::vector<Vec3>& force);

 private:
  void collect_viscosity(const ForceModel& force_model);

  bool is_viscous_ = false;
  std::vector<DamperBlock> blocks_;             ///< of particles
  std::vector<std::vector<Real>> viscosities_;  ///< mu V_i V_j laplacian W, as liquid_pairs [N s/m]
  std::vector<Vec3> by_slot_;                   ///< w of liquid slots
};

}  // namespace vat
