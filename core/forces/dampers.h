#pragma once

#include <vector>

#include "core/step/workspace.h"

namespace vat {

struct ForceModel;

/// Adds what a friction of `drag` [N s/m] (see core/forces/friction.h) across the unit vector
/// `normal` is to a solve: the drag is kept as it is, so that what it solves for loses energy and
/// does not turn round, and may pass mu F_n by as much as the slip grows within half a step.
void add_drag(Real drag, Index other, const Vec3& normal, std::vector<Damper>& dampers);

/// Forces that depend on velocities, at one configuration, as a symmetric, negative semi-definite
/// matrix D: when velocities change by w, forces change by D w. Contacts that do not push are left
/// out, as are users' grabs.
class DampingMatrix {
 public:
  /// Of the configuration that `force_model` was last evaluated at, its workspace keeping dampers;
  /// without the liquids' viscosity and their drag of settling where those are not asked for.
  void collect(const ForceModel& force_model, const Configuration& at, Real time, bool viscosity);

  /// force = D w, both with an entry for each particle.
  void multiply(const ForceModel& force_model, const std::vector<Vec3>& w,
                std::vector<Vec3>& force);

 private:
  void collect_viscosity(const ForceModel& force_model);

  bool is_viscous_ = false;
  std::vector<DamperBlock> blocks_;             ///< of particles, without springs and contacts
  std::vector<std::vector<Real>> viscosities_;  ///< mu V_i V_j laplacian W, as liquid_pairs [N s/m]
  std::vector<Vec3> by_slot_;                   ///< w of liquid slots
};

}  // namespace vat
