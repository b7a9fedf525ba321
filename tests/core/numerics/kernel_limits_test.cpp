#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/kernels/smoothing_kernel.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/numerics/step_limits.h"
#include "tests/support/name_of.h"
#include "tests/support/scenes.h"

namespace vat::test::kernel_limits_test {
namespace {

// The stable step of a liquid follows from the shortest waves on a cubic lattice. The tests sum
// these from the kernel.

constexpr Real kSupport = 1;

struct Rates {
  Real omega2 = 0;  ///< sound with a speed of 1 m/s
  Real decay = 0;   ///< viscosity of 1 m^2/s
};

/// Returns the rates of a wave on the lattice: density of the displacements, and friction between
/// the particles.
Rates rates_of(const SmoothingKernel& kernel, Real spacing, const Vec3& wave) {
  const int reach = static_cast<int>(kSupport / spacing);
  const Real volume = spacing * spacing * spacing / lattice_sum(kernel, kSupport, spacing, 3);
  const Real steepness =
      lattice_slope(kernel, kSupport, spacing, 3) * volume / (spacing * spacing * spacing);
  Vec3 slope = Vec3::Zero();
  Mat3 friction = Mat3::Zero();
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      for (int k = -reach; k <= reach; ++k) {
        const Vec3 x = spacing * Vec3(i, j, k);
        const Real r = x.norm();
        if (r == 0 || r >= kSupport) continue;
        const Real g = volume * kernel.slope_over_r(r);
        slope += g * std::sin(wave.dot(x)) * x;
        const Real h = kSupport / 2;
        friction -= 10 * g * (1 - std::cos(wave.dot(x))) / (r * r + 0.01 * h * h) * x *
                    x.transpose() / steepness;
      }
    }
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(friction);
  return {slope.squaredNorm() / steepness, solver.eigenvalues().maxCoeff()};
}

/// Returns the largest rates of waves along the lattice directions.
Rates greatest_rates(KernelId id, Real spacing) {
  const SmoothingKernel kernel(id, kSupport, 3);
  Rates greatest;
  const std::array<Vec3, 5> directions = {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1),
                                          Vec3(2, 1, 0), Vec3(2, 1, 1)};
  for (const Vec3& direction : directions) {
    for (int n = 1; n <= 40; ++n) {
      const Real length = std::numbers::pi * n / (40 * spacing * direction.maxCoeff());
      const Rates rates = rates_of(kernel, spacing, length * direction);
      greatest = {std::max(greatest.omega2, rates.omega2), std::max(greatest.decay, rates.decay)};
    }
  }
  return greatest;
}

/// Returns the stable step of a liquid with a given speed of sound or kinematic viscosity.
Real step_limit(KernelId id, Real speed, Real viscosity) {
  Scene scene = make_scene(IntegratorId::symplectic_euler, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.kernel = id;
  scene.gravity.setZero();
  scene.materials = {make_liquid("water", 1000, {speed * speed, 1000 * viscosity, kSupport})};
  scene.materials[0].liquid->artificial_viscosity = 0;
  scene.bodies = {{"pool", BodyKind::liquid, "water", BoxShape{{0, 0, 0}, {2, 2, 2}}, 0.5}};
  const auto limits = find_step_limits(scene, sample_bodies(scene));
  return limits.at(0).step;
}

class KernelLimits : public testing::TestWithParam<KernelId> {};

TEST_P(KernelLimits, AreThoseOfTheShortestWavesOnALattice) {
  const Real sound = step_limit(GetParam(), 1, 0) / compressed_step_share(3);
  const Real viscous = step_limit(GetParam(), 0, 1);
  Real least_sound = 10;
  Real least_viscous = 10;
  for (const Real reach : {2.0, 2.5, 3.0, 4.0}) {
    const Rates rates = greatest_rates(GetParam(), kSupport / reach);
    least_sound = std::min(least_sound, 2 / std::sqrt(rates.omega2));
    least_viscous = std::min(least_viscous, 2 / rates.decay);
  }
  EXPECT_NEAR(sound, least_sound, 0.01 * least_sound);
  EXPECT_NEAR(viscous, least_viscous, 0.03 * least_viscous);
}

INSTANTIATE_TEST_SUITE_P(Kernels, KernelLimits,
                         testing::Values(KernelId::wendland_c2, KernelId::cubic_spline), NameOf());

}  // namespace
}  // namespace vat::test::kernel_limits_test
