#pragma once

#include <vector>

#include "core/contact/scratch.h"
#include "core/damping/solid_drags.h"
#include "core/liquid/pairs/viscous_images.h"
#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

struct ForceModel;

/// Forces that depend on velocities, at one configuration, as a symmetric, negative semi-definite
/// matrix D: when velocities change by w, forces change by D w. Contacts that do not push are left
/// out, as are users' grabs. Friction keeps its drag as it is, so that what is solved for loses
/// energy and does not turn round; it may pass mu F_n by as much as slip grows within half a step.
class DampingMatrix {
 public:
  /// Of the configuration that `force_model` was last evaluated at, its workspace keeping dampers;
  /// without the liquids' viscosity and their drag of settling where those are not asked for.
  void collect(const ForceModel& force_model, const Configuration& at, Real time, bool viscosity);

  /// The rigid particles that D is not zero for, in order.
  const std::vector<Index>& rigid_particles() const { return rigid_; }

  /// force = D w, by particle; of rigid ones only the above are read in w. `spins` are what w has
  /// by rigid body, and `torque` is friction's on rigid particles about their centres, where there
  /// is any.
  void multiply(const ForceModel& force_model, const std::vector<Vec3>& w,
                const std::vector<Vec3>& spins, std::vector<Vec3>& force,
                std::vector<Vec3>& torque);

 private:
  void collect_own(const ForceModel& force_model, const Configuration& at, Real time,
                   bool viscosity);
  void collect_viscosity(const ForceModel& force_model);
  void collect_rigid(const ForceModel& force_model);
  /// Calls visit(dampers) for those of a block of particles.
  template <class F>
  void for_kept_blocks(const ForceModel& force_model, std::size_t block, F&& visit) const;

  bool has_own_ = false;
  bool is_viscous_ = false;
  bool has_images_ = false;
  ViscousImages images_;
  bool has_solid_drags_ = false;
  SolidDrags solid_drags_;
  std::vector<DamperBlock> own_;  ///< of liquid particles, without their viscosity
  std::vector<Index> rigid_;
  std::vector<std::vector<Real>> viscosities_;  ///< mu V_i V_j laplacian W, as liquid_pairs [N s/m]
  std::vector<Vec3> by_slot_;                   ///< w of liquid slots
};

}  // namespace vat
