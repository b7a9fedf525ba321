#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/kernels/smoothing_kernel.h"
#include "core/liquid/pairs/weakly_compressible_pairs.h"
#include "core/liquid/surface/cohesion.h"

// The source of the constants of cohesion: layers of a continuous liquid relax below a free surface
// or at a wall. The support radius is 1, and A = 2.

namespace vat::cohesion_profile_test {
namespace {

constexpr int kPerSupport = 10;  // layers
constexpr Real kLayer = 1.0 / kPerSupport;
constexpr Real kSound2 = 25;  // rho c^2, relative to the attraction of the far part
constexpr Real kReach = CohesionKernel::kReach;

/// The integral of the density kernel over a plane.
class PlaneKernel {
 public:
  PlaneKernel() {
    const SmoothingKernel kernel(KernelId::wendland_c2, 1, 3);
    for (int n = 0; n <= kCount; ++n) {
      Real sum = 0;
      const Real z = static_cast<Real>(n) / kCount;
      for (int k = 0; k < 400; ++k) {
        const Real r = z + (1 - z) * (k + 0.5) / 400;
        sum += 2 * std::numbers::pi * r * kernel.value(r) * (1 - z) / 400;
      }
      values_.push_back(sum);
    }
  }
  Real value(Real z) const {
    const Real place = std::abs(z) * kCount;
    if (place >= kCount) return 0;
    const auto n = static_cast<std::size_t>(place);
    return values_[n] + (place - static_cast<Real>(n)) * (values_[n + 1] - values_[n]);
  }
  Real slope(Real z) const { return (value(z + 1e-3) - value(z - 1e-3)) / 2e-3; }

 private:
  static constexpr int kCount = 1000;
  std::vector<Real> values_;
};

/// Layers at z < 0. The lower half is fixed.
class Surface {
 public:
  /// `share` is the share of the wall at z = 0. Without it, the surface is free.
  explicit Surface(std::optional<Real> share) : share_(share) {
    for (int n = 0; n < kCount; ++n) z_.push_back(-(n + 0.5) * kLayer);
    for (int n = -kPerSupport; n <= kPerSupport; ++n) lattice_ += kLayer * plane_.value(n * kLayer);
    force_.resize(kFree);
    pressure_.resize(kCount);
    relax();
  }

  /// Returns the energy of the surface, relative to that of a free surface of the uniform liquid.
  Real tension() const {
    Real sum = 0;
    for (int i = 0; i < kFree; ++i) {
      Real energy = pressure_energy(density(i));
      for (int j = 0; j < kCount; ++j) energy -= kLayer * attraction(z_[i] - z_[j], 1);
      energy -= share_ ? 2 * wall_energy(-z_[i]) : 0;
      sum += kLayer * energy;
    }
    return sum / (CohesionKernel::first_moment(3) * (kReach - CohesionKernel::kCore));
  }

 private:
  static constexpr int kFree = 3 * kPerSupport;
  static constexpr int kCount = 6 * kPerSupport;

  Real attraction(Real z, Real share) const { return kernel_.over_plane(std::abs(z), share); }
  Real attraction_slope(Real z) const {
    return (attraction(z + 1e-3, 1) - attraction(z - 1e-3, 1)) / 2e-3;
  }
  Real wall_energy(Real distance) const {
    Real sum = 0;
    for (int n = 0; n < 100; ++n) {
      sum += attraction(distance + kReach * (n + 0.5) / 100, *share_) * kReach / 100;
    }
    return sum;
  }
  /// Returns the density of layer i, including the images behind the wall.
  Real density(int i) const {
    Real sum = 0;
    for (int j = 0; j < kCount; ++j) {
      sum += plane_.value(z_[i] - z_[j]);
      if (share_) sum += plane_.value(z_[i] + z_[j]);
    }
    return i < kCount - 2 * kPerSupport ? sum * kLayer / lattice_ : 1;
  }
  /// Returns p / s^2.
  static Real pressure_over_s2(Real s) {
    return std::max(-kTensileShare, kSound2 * tait_pressure(s) / (s * s));
  }
  static Real pressure_energy(Real s) {
    Real sum = 0;
    for (int n = 0; n < 100; ++n) sum += pressure_over_s2(1 + (s - 1) * (n + 0.5) / 100);
    return sum * (s - 1) / 100;
  }
  Real force_on(int i) const {
    Real sum = 0;
    for (int j = 0; j < kCount; ++j) {
      const Real both = (pressure_[i] + pressure_[j]) / lattice_;
      sum += kLayer * (2 * attraction_slope(z_[i] - z_[j]) - both * plane_.slope(z_[i] - z_[j]));
      if (share_) sum -= kLayer * both * plane_.slope(z_[i] + z_[j]);
    }
    return share_ ? sum + 2 * attraction(z_[i], *share_) : sum;
  }
  /// Moves the layers with damping for a time in which they come to rest.
  void relax() {
    std::vector<Real> speed(kFree, 0);
    const Real step = 0.2 * kLayer / std::sqrt(kSound2);
    for (int n = 0; n < 1500; ++n) {
      for (int i = 0; i < kCount; ++i) pressure_[i] = pressure_over_s2(density(i));
      for (int i = 0; i < kFree; ++i) force_[i] = force_on(i);
      for (int i = 0; i < kFree; ++i) {
        speed[i] = 0.99 * (speed[i] + step * force_[i]);
        z_[i] += step * speed[i];
        if (share_ && z_[i] > 0) z_[i] = speed[i] = 0;
      }
    }
  }

  std::optional<Real> share_;
  PlaneKernel plane_;
  CohesionKernel kernel_{1, 0.05, 3};
  Real lattice_ = 0;
  std::vector<Real> z_;
  std::vector<Real> pressure_;
  std::vector<Real> force_;
};

TEST(CohesionProfile, GivesTheTensionOfASurfaceAtRest) {
  EXPECT_NEAR(Surface({}).tension(), kRelaxation, 0.03 * kRelaxation);
}

TEST(CohesionProfile, GivesTheAnglesOfWalls) {
  for (const Real cosine : {-0.7, -0.3, 0.0, 0.4, 0.8}) {
    EXPECT_NEAR(-Surface(adhesion_share(cosine)).tension() / kRelaxation, cosine, 0.03);
  }
}

}  // namespace
}  // namespace vat::cohesion_profile_test
