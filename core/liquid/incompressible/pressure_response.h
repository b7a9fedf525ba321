#pragma once

#include <span>
#include <vector>

#include "core/evaluation/force_model.h"
#include "core/liquid/pairs/pair_sums.h"

namespace vat {

/// Buffers of PressureResponse.
struct ResponseScratch {
  std::vector<Real> acceleration_factor;  ///< by liquid slot: slope_factor() / rho, or 0 if fixed
  std::vector<Real> rate_factor;          ///< by liquid slot: slope_factor() / G
  std::vector<Real> inertia;              ///< by liquid slot: m / G, or 0 if fixed [kg]
  std::vector<Real> partial;              ///< by block of slots
  std::vector<Vec3> liquid_motion;  ///< by liquid slot: velocity [m/s] or acceleration [m/s^2]
  std::vector<Vec3> liquid_whole;   ///< by liquid slot: total acceleration [m/s^2]
  std::vector<Vec3> solid_motion;   ///< by solid slot: velocity [m/s] or acceleration [m/s^2]
  std::vector<Vec3> solid_force;    ///< by solid particle [N]
  std::vector<Vec3> rigid_force;    ///< by rigid body [N]
  std::vector<Vec3> rigid_torque;   ///< by rigid body, about its centre of mass [N m]
  std::vector<Vec3> rigid_turning;  ///< by rigid body: angular acceleration by the torque [1/s^2]
  std::vector<Vec3> solid_force_whole;
  std::vector<Vec3> rigid_force_whole;
  std::vector<Vec3> rigid_torque_whole;
  Forces unused;  ///< placeholder for the forces of a StepContext
};

/// The linear response of a liquid and its solids at fixed positions. The response consists of the
/// accelerations by pressures, and of the density rates by velocities or accelerations.
///
/// With the rest volumes V, the relative density s_i = sum_j V_j W_ij and the pressures p of liquid
/// particles:
///
///   D_i(v) = sum_j V_j grad_i W_ij . (v_i - v_j)                      ds_i/dt
///   F_i = -V_i sum_j V_j (p_i + p_j) G grad_i W_ij                    G: the kernel's slope_scale
///
/// The force is F = -G (V D)^T p, so that the matrix of -V D M^-1 F is symmetric and positive
/// semi-definite for the masses M. The sums include images in walls, with the values of their
/// particles. For particle i, a solid particle b counts as a mirror image of i, with the pressure
/// p_i and the velocity 2 v_b - v_i: F_i = -2 V_i V_b p_i G grad_i W_ib = -F_b.
///
/// The term motion denotes the velocities or accelerations in ResponseScratch::liquid_motion and
/// solid_motion. The sums use the pairs of the workspace. The functions change the weights and
/// motions of the workspace's PairSources.
class PressureResponse {
 public:
  /// The positions of `at` must be those for which the pairs and densities of the workspace were
  /// computed. If `solids_move` is false, solids are fixed.
  PressureResponse(const ForceModel& force_model, Configuration& at, ResponseScratch& scratch,
                   bool solids_move);

  /// Sets the motion to the accelerations by `pressure` [Pa], which is by liquid slot.
  void accelerate(std::span<const Real> pressure);
  /// Sets the motion to the velocities relative to walls with the velocity `wall_velocity` [m/s].
  void see_velocities(const Vec3& wall_velocity);
  /// Returns the sum of -p V D of the motion, if the motion is that of accelerate(p). The matrix is
  /// D M^-1 D^T up to factors. The sum is therefore that of F.a / G, for the forces F and
  /// accelerations a.
  Real energy();

  /// Sets `rate` to D of the motion, by liquid slot.
  void compress(std::span<Real> rate);
  /// Sets product[slot] to factor * scale[slot] * D(motion)[slot].
  void compress(std::span<Real> product, std::span<const Real> scale, Real factor);
  /// Computes an upper bound of the diagonal of the matrix of -V D M^-1 F, by liquid slot.
  void find_diagonal(std::span<Real> diagonal);

  /// Adds `share` times the present accelerations to the total accelerations, which are zero at
  /// first. May be called once for each accelerate().
  void add(Real share);

  /// Adds `dt` times the total accelerations to the velocities.
  void kick(Real dt);
  /// Adds `share` times the total accelerations of the liquid to its positions.
  void shift(Real share);

 private:
  /// Sets the factors of the liquid slots. The sums would otherwise collect them in each iteration.
  void set_factors();
  /// Adds the accelerations of the last add() to the stored total.
  void store_whole();
  /// Returns the total of `whole` and the share of `part` of the last add().
  Vec3 total(const std::vector<Vec3>& whole, const std::vector<Vec3>& part, std::size_t n) const {
    const Vec3 last = share_ * part[n];
    return has_whole_ ? Vec3(whole[n] + last) : last;
  }
  /// Doubles the weights of solids, because solids count as mirror images.
  void weigh_solids();
  void charge(std::span<const Real> pressure);
  void accelerate_liquid(std::span<const Real> pressure);
  template <class Scale>
  void compress_to(std::span<Real> rate, Scale&& scale);
  void push_solids(std::span<const Real> pressure);
  void sum_solid_forces();
  void sum_rigid_forces();
  Vec3 solid_acceleration(Index particle) const;
  /// Computes LiquidScratch::volume_slopes, unless the density stage has computed them.
  void find_slopes();
  Real mobility_of_liquid(Index particle) const;

  const ForceModel& f_;
  Configuration& at_;
  const StepContext context_;
  const PairSums& sums_;
  ResponseScratch& scratch_;
  const std::span<const Index> order_;
  const std::span<const Index> solids_;
  const bool has_solids_;
  const bool solids_move_;
  const bool has_several_liquids_;
  bool has_whole_ = false;  ///< the total includes the stored total
  bool has_share_ = false;  ///< the total includes share_ times the present accelerations
  Real share_ = 0;
  const Real greatest_mobility_;  ///< maximum of 1/m over the liquids [1/kg]
};

}  // namespace vat
