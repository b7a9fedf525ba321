#include "core/sampling/mass_properties.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/scenes.h"

namespace vat::test::mass_properties_test {
namespace {

SampledBody make_sample(std::vector<Vec3> positions, std::vector<Real> masses, Real radius) {
  SampledBody sample;
  sample.radii.assign(positions.size(), radius);
  sample.velocities.assign(positions.size(), Vec3::Zero());
  sample.positions = std::move(positions);
  sample.masses = std::move(masses);
  return sample;
}

TEST(MassProperties, OfADumbbell) {
  const MassProperties p = mass_properties(make_sample({{-1, 0, 0}, {3, 0, 0}}, {3, 1}, 0.5));
  EXPECT_EQ(p.mass, 4);
  EXPECT_EQ(p.center_of_mass, Vec3::Zero());
  // 3 * 1^2 + 1 * 3^2 about the transverse axes, and 2/5 m r^2 of each sphere about every axis.
  EXPECT_LT((p.inertia - Mat3(Vec3(0.4, 12.4, 12.4).asDiagonal())).norm(), 1e-14);
}

TEST(MassProperties, HaveProductsOfInertia) {
  const MassProperties p = mass_properties(make_sample({{1, 1, 0}, {-1, -1, 0}}, {2, 2}, 1e-6));
  Mat3 expected;
  expected << 4, -4, 0, -4, 4, 0, 0, 0, 8;
  EXPECT_LT((p.inertia - expected).norm(), 1e-10);
}

TEST(MassProperties, DoNotDependOnWhereTheBodyIs) {
  const std::vector<Vec3> points = make_lattice(3, 4, 5, 0.1);
  std::vector<Vec3> moved = points;
  for (Vec3& p : moved) p += Vec3(10, -20, 30);
  const std::vector<Real> masses(points.size(), 0.3);
  const MassProperties here = mass_properties(make_sample(points, masses, 0.05));
  const MassProperties there = mass_properties(make_sample(moved, masses, 0.05));
  EXPECT_LT((there.center_of_mass - Vec3(10, -20, 30)).norm(), 1e-13);
  EXPECT_LT((here.inertia - there.inertia).norm(), 1e-13 * here.inertia.norm());
}

}  // namespace
}  // namespace vat::test::mass_properties_test
