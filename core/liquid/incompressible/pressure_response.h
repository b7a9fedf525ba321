#pragma once

#include <span>
#include <vector>

#include "core/evaluation/force_model.h"
#include "core/liquid/pairs/pair_sums.h"

namespace vat {

/// Buffers of PressureResponse.
struct ResponseScratch {
  std::vector<Vec3> liquid_motion;  ///< by liquid slot: velocity [m/s] or acceleration [m/s^2]
  std::vector<Vec3> liquid_whole;   ///< sum of accelerations, by liquid slot
  std::vector<Vec3> solid_motion;   ///< by solid slot: velocity [m/s] or acceleration [m/s^2]
  std::vector<Vec3> solid_force;    ///< by solid particle [N]
  std::vector<Vec3> rigid_force;    ///< by rigid body [N]
  std::vector<Vec3> rigid_torque;   ///< by rigid body, about its centre of mass [N m]
  std::vector<Vec3> solid_force_whole;
  std::vector<Vec3> rigid_force_whole;
  std::vector<Vec3> rigid_torque_whole;
  Forces unused;  ///< required by StepContext
};

/// Computes the accelerations of a liquid and its solids by pressures, and the density rate of the
/// liquid by motions, at the positions of one step.
///
/// With rest volumes V, s_i = sum_j V_j W_ij and pressures p, both at liquid particles:
///
///   D_i(v) = sum_j V_j grad_i W_ij . (v_i - v_j)                      ds_i/dt
///   F_i = -V_i sum_j V_j (p_i + p_j) G grad_i W_ij                    G: the kernel's slope_scale
///
/// so that F = -G (V D)^T p, and -V D M^-1 F is symmetric and positive semi-definite. Images in
/// walls take part with the values of their particles. For particle i, a solid particle b has the
/// pressure p_i and the velocity 2 v_b - v_i, as a mirror of i: F_i = -2 V_i V_b p_i G grad_i W_ib
/// = -F_b.
///
/// The present motion is stored in the scratch. Uses the pairs in the workspace. Changes the
/// weights and motions of the workspace's sources.
class PressureResponse {
 public:
  /// `at` has the positions for which pairs and densities were found. `solids_move`: whether solids
  /// move or are held.
  PressureResponse(const ForceModel& force_model, Configuration& at, ResponseScratch& scratch,
                   bool solids_move);

  /// Sets the motion to the accelerations by `pressure`, by slot.
  void accelerate(std::span<const Real> pressure);
  /// Sets the motion to the velocities relative to walls that move with `wall_velocity`.
  void see_velocities(const Vec3& wall_velocity);

  /// rate = D of the motion, by slot.
  void compress(std::span<Real> rate);
  /// product[slot] = factor * scale[slot] * D(motion)[slot].
  void compress(std::span<Real> product, std::span<const Real> scale, Real factor);
  /// Computes an upper bound of the diagonal of -V D M^-1 F, by slot.
  void find_diagonal(std::span<Real> diagonal);

  /// Adds `share` of the present accelerations to the total, or replaces the total by them. The
  /// total is zero at first.
  void add(Real share);
  void replace();

  /// Adds `dt` times the total accelerations to the velocities.
  void kick(Real dt);
  /// Adds `share` times the total accelerations of the liquid to its positions.
  void shift(Real share);

 private:
  /// Gives solids double weight, because they mirror the liquid.
  void weigh_solids();
  /// Sets the motion of a liquid slot, also as a source.
  void set_liquid_motion(std::size_t slot, const Vec3& motion);
  void charge(std::span<const Real> pressure);
  PairInputs charged_inputs() const;
  void accelerate_liquid(std::span<const Real> pressure);
  template <class Scale>
  void compress_to(std::span<Real> rate, Scale&& scale);
  void push_solids(std::span<const Real> pressure);
  void sum_solid_forces();
  void sum_rigid_forces();
  Vec3 solid_acceleration(Index particle) const;
  /// Computes the slopes of the volumes, if the density stage has not.
  void find_slopes();
  Real mobility_of_liquid(Index particle) const;
  Real mobility_of(Index particle) const;

  const ForceModel& f_;
  Configuration& at_;
  const StepContext context_;
  const PairSums& sums_;
  ResponseScratch& scratch_;
  const std::span<const Index> order_;
  const std::span<const Index> solids_;
  const bool has_solids_;
  const bool solids_move_;
  bool has_whole_ = false;
  const Real greatest_mobility_;  ///< of the liquids
};

}  // namespace vat
