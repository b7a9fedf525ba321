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
/// matrix D: if velocities change by w, forces change by D w. It does not include contacts without
/// a force, and grabs. Friction keeps its drag coefficient, so that the solution loses energy and
/// does not reverse; it may exceed mu F_n by the growth of the slip within half a step.
class DampingMatrix {
 public:
  /// Collects the forces of the configuration at which `force_model` was last evaluated with
  /// keep_dampers. `viscosity`: includes viscosity and settling drag of liquids.
  void collect(const ForceModel& force_model, const Configuration& at, Real time, bool viscosity);

  /// The rigid particles with nonzero rows of D, in ascending order.
  const std::vector<Index>& rigid_particles() const { return rigid_; }

  /// force = D w, by particle. Among rigid particles, only the entries of rigid_particles() are
  /// read in w. `spins` are the angular velocities of w by rigid body. `torque` is that of friction
  /// on rigid particles about their centres, if there is friction.
  void multiply(const ForceModel& force_model, const std::vector<Vec3>& w,
                const std::vector<Vec3>& spins, std::vector<Vec3>& force,
                std::vector<Vec3>& torque);

 private:
  void collect_own(const ForceModel& force_model, const Configuration& at, Real time,
                   bool viscosity);
  void collect_viscosity(const ForceModel& force_model);
  void collect_rigid(const ForceModel& force_model);
  /// Calls visit(dampers) for the dampers of a block of particles.
  template <class F>
  void for_kept_blocks(const ForceModel& force_model, std::size_t block, F&& visit) const;

  bool has_own_ = false;
  bool is_viscous_ = false;
  bool has_images_ = false;
  ViscousImages images_;
  bool has_solid_drags_ = false;
  SolidDrags solid_drags_;
  std::vector<DamperBlock> own_;  ///< of liquid particles, without viscosity
  std::vector<Index> rigid_;
  std::vector<std::vector<Real>>
      viscosities_;            ///< mu V_i V_j laplacian W, in the order of liquid_pairs [N s/m]
  std::vector<Vec3> by_slot_;  ///< w of liquid slots
};

}  // namespace vat
