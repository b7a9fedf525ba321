#pragma once

#include <vector>

#include "core/contact/scratch.h"
#include "core/stage/context.h"
#include "core/state/state.h"

namespace vat {

/// The symmetric, negative semi-definite matrix D of all velocity-dependent forces at one
/// configuration. A change w of the velocities changes the forces by D w. D excludes grabs, and
/// contacts that exert no force. The drag coefficient of friction is constant during the solve, so
/// that friction dissipates energy and does not reverse the slip. Friction may exceed mu F_n if the
/// slip speed grows within half a step.
class DampingMatrix {
 public:
  /// Collects the forces of the configuration of `context`, at which the forces were last
  /// evaluated with Scratch::keep_dampers. If `viscosity` is true, D includes the viscosity and the
  /// settling drag of liquids.
  void collect(const StepContext& context, bool viscosity);

  /// Returns the blocks of particles that may have nonzero rows of D, in ascending order.
  const std::vector<std::size_t>& blocks() const { return blocks_; }

  /// Returns the rigid particles with nonzero rows of D, in ascending order.
  const std::vector<Index>& rigid_particles() const { return rigid_; }

  /// Computes force = D w, by particle, for the particles of blocks(). Of the rigid particles, the
  /// function reads only the entries of rigid_particles() in `w`. `spins` contains the angular
  /// velocity of each rigid body that belongs to `w`. The function adds to `torque`, by particle,
  /// the torque of friction on each rigid particle about the particle's centre. If there is no
  /// friction, `torque` may be empty.
  void multiply(const StepContext& context, const std::vector<Vec3>& w,
                const std::vector<Vec3>& spins, std::vector<Vec3>& force,
                std::vector<Vec3>& torque);

 private:
  void collect_own(const StepContext& context, bool viscosity);
  void collect_viscosity(const StepContext& context);
  void collect_blocks(const StepContext& context);
  void collect_rigid(const StepContext& context);
  /// Calls visit(dampers) for the dampers of a block of particles.
  template <class F>
  void for_kept_blocks(const StepContext& context, std::size_t block, F&& visit) const;

  bool has_own_ = false;
  bool has_liquid_drags_ = false;  ///< viscosity of coupled liquids
  bool is_viscous_ = false;        ///< viscosity of other liquids
  std::vector<std::size_t> blocks_;
  std::vector<DamperBlock> own_;  ///< liquid particles, without viscosity
  std::vector<Index> rigid_;
  std::vector<std::vector<Real>>
      viscosities_;            ///< mu V_i V_j laplacian W, in the order of liquid_pairs [N s/m]
  std::vector<Vec3> by_slot_;  ///< w, indexed by liquid slot (index in cell order)
};

}  // namespace vat
