#include "core/sampling/mass_properties.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/support/scenes.h"

namespace vat::mass_properties_test {
namespace {

SampledBody make_sample(std::vector<Vec3> positions, std::vector<Real> masses, Real radius) {
  SampledBody sample;
  sample.radii.assign(positions.size(), radius);
  sample.velocities.assign(positions.size(), Vec3::Zero());
  sample.positions = std::move(positions);
  sample.masses = std::move(masses);
  return sample;
}

Mat3 diagonal(Real xx, Real yy, Real zz) {
  return Vec3(xx, yy, zz).asDiagonal();
}

TEST(MassProperties, OfOneParticleAreThoseOfASphere) {
  const MassProperties p = mass_properties(make_sample({{1, 2, 3}}, {5}, 0.5));
  EXPECT_EQ(p.mass, 5);
  EXPECT_EQ(p.center_of_mass, Vec3(1, 2, 3));
  EXPECT_LT((p.inertia - 0.4 * 5 * 0.25 * Mat3::Identity()).norm(), 1e-15);
}

TEST(MassProperties, OfADumbbell) {
  const MassProperties p = mass_properties(make_sample({{-1, 0, 0}, {3, 0, 0}}, {3, 1}, 0.5));
  EXPECT_EQ(p.mass, 4);
  EXPECT_EQ(p.center_of_mass, Vec3::Zero());
  // 3 * 1^2 + 1 * 3^2 about the transverse axes, and 2/5 m r^2 of each sphere about every axis.
  EXPECT_LT((p.inertia - diagonal(0.4, 12.4, 12.4)).norm(), 1e-14);
}

TEST(MassProperties, HaveProductsOfInertia) {
  const MassProperties p = mass_properties(make_sample({{1, 1, 0}, {-1, -1, 0}}, {2, 2}, 1e-6));
  Mat3 expected;
  expected << 4, -4, 0, -4, 4, 0, 0, 0, 8;
  EXPECT_LT((p.inertia - expected).norm(), 1e-10);
}

TEST(MassProperties, DoNotDependOnWhereTheBodyIs) {
  const std::vector<Vec3> points = test::make_lattice(3, 4, 5, 0.1);
  std::vector<Vec3> moved = points;
  for (Vec3& p : moved) p += Vec3(10, -20, 30);
  const std::vector<Real> masses(points.size(), 0.3);
  const MassProperties here = mass_properties(make_sample(points, masses, 0.05));
  const MassProperties there = mass_properties(make_sample(moved, masses, 0.05));
  EXPECT_LT((there.center_of_mass - Vec3(10, -20, 30)).norm(), 1e-13);
  EXPECT_LT((here.inertia - there.inertia).norm(), 1e-13 * here.inertia.norm());
}

/// Samples a body of mass 1 with a lattice of n points per unit length in [-1, 1]^3. `inside`
/// selects the points.
MassProperties sample_solid(int n, const std::function<bool(const Vec3&)>& inside) {
  const Real spacing = 1.0 / n;
  std::vector<Vec3> points;
  for (const Vec3& p : test::make_lattice(2 * n, 2 * n, 2 * n, spacing)) {
    if (inside(p)) points.push_back(p);
  }
  const std::vector<Real> masses(points.size(), 1 / static_cast<Real>(points.size()));
  return mass_properties(make_sample(points, masses, spacing / 2));
}

// A cube of side a has I = m a^2 / 6 about its centre. A lattice of n^3 points has m (a^2 - s^2)/6
// with s = a/n. The spheres of radius s/2 add m s^2/10. The sum is exact.
TEST(MassProperties, OfALatticeBoxAreExact) {
  for (const int n : {1, 2, 5, 12}) {
    const Real s = 1.0 / n;
    const MassProperties p = sample_solid(n, [](const Vec3&) { return true; });
    const Real expected = (4 - s * s) / 6 + s * s / 10;
    EXPECT_LT((p.inertia - expected * Mat3::Identity()).norm(), 1e-12) << n;
  }
}

/// Expects an error of at most first order in the spacing, since the stepped surface is one cell
/// thick.
void expect_converges(const std::function<bool(const Vec3&)>& inside, const Mat3& exact) {
  for (const int n : {8, 16, 32}) {
    const Real error = (sample_solid(n, inside).inertia - exact).norm() / exact.norm();
    EXPECT_LT(error, 0.5 / n) << n << " points a radius";
  }
}

TEST(MassProperties, OfASphereConverge) {
  expect_converges([](const Vec3& p) { return p.norm() <= 1; }, 0.4 * Mat3::Identity());
}

TEST(MassProperties, OfACylinderConverge) {
  // m = R = 1, height 2: I_zz = 1/2, I_xx = (3 R^2 + h^2)/12 = 7/12.
  expect_converges([](const Vec3& p) { return p.head<2>().norm() <= 1; },
                   diagonal(7.0 / 12, 7.0 / 12, 0.5));
}

}  // namespace
}  // namespace vat::mass_properties_test
