#include "core/sampling/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "tests/core/sampling/mesh_shapes.h"

namespace vat::sampling_test {
namespace {

Material steel() {
  Material material;
  material.name = "steel";
  material.density = 8000;
  return material;
}

BodyDescription rigid(Shape shape, Real spacing) {
  BodyDescription body;
  body.kind = BodyKind::rigid;
  body.shape = std::move(shape);
  body.spacing = spacing;
  return body;
}

Real total_mass(const SampledBody& body) {
  return std::accumulate(body.masses.begin(), body.masses.end(), Real{0});
}

TEST(Sampling, FillsABoxWithWholeCells) {
  const SampledBody body = sample_body(rigid(BoxShape{{1, 2, 3}, {0.3, 0.2, 0.1}}, 0.05), steel());
  ASSERT_EQ(body.positions.size(), 6u * 4u * 2u);
  // x varies fastest. The first particle is half a spacing from the faces.
  EXPECT_TRUE(body.positions.front().isApprox(Vec3(0.875, 1.925, 2.975), 1e-14));
  EXPECT_TRUE(body.positions[1].isApprox(Vec3(0.925, 1.925, 2.975), 1e-14));
  EXPECT_TRUE(body.positions.back().isApprox(Vec3(1.125, 2.075, 3.025), 1e-14));
  EXPECT_DOUBLE_EQ(body.radii.front(), 0.025);
}

TEST(Sampling, PutsOneLayerIntoAThinShape) {
  const SampledBody body = sample_body(rigid(BoxShape{{0, 0, 0}, {0.5, 0.5, 0.01}}, 0.1), steel());
  EXPECT_EQ(body.positions.size(), 25u);
  for (const Vec3& position : body.positions) EXPECT_EQ(position.z(), 0);
}

TEST(Sampling, KeepsThePointsInsideASphere) {
  const SampledBody body = sample_body(rigid(SphereShape{{0, 0, 0}, 1}, 0.05), steel());
  for (const Vec3& position : body.positions) EXPECT_LE(position.norm(), 1 + 1e-9);
  // Gauss circle problem: the number of lattice points in a sphere is its volume, with an error of
  // the order of its surface.
  const Real cells = 4 * std::numbers::pi / 3 / std::pow(0.05, 3);
  const Real surface_cells = 4 * std::numbers::pi / std::pow(0.05, 2);
  EXPECT_NEAR(static_cast<Real>(body.positions.size()), cells, 0.1 * surface_cells);
}

TEST(Sampling, KeepsThePointsInsideATiltedCylinder) {
  const Vec3 axis = Vec3(1, 2, -1).normalized();
  const CylinderShape cylinder{{0.3, 0, 0}, 5 * axis, 0.2, 1};
  const SampledBody body = sample_body(rigid(cylinder, 0.02), steel());
  Real farthest_along = 0;
  Real farthest_across = 0;
  for (const Vec3& position : body.positions) {
    const Vec3 x = position - cylinder.center;
    farthest_along = std::max(farthest_along, std::abs(x.dot(axis)));
    farthest_across = std::max(farthest_across, (x - x.dot(axis) * axis).norm());
  }
  EXPECT_LE(farthest_along, 0.5 + 1e-9);
  EXPECT_GT(farthest_along, 0.5 - 0.02);
  EXPECT_LE(farthest_across, 0.2 + 1e-9);
  EXPECT_GT(farthest_across, 0.2 - 0.02);
  const Real cells = std::numbers::pi * 0.04 / std::pow(0.02, 3);
  EXPECT_NEAR(static_cast<Real>(body.positions.size()), cells, 0.03 * cells);
}

TEST(Sampling, GivesSolidsTheMassOfTheirExactVolume) {
  const Real pi = std::numbers::pi;
  const auto mass_of = [](Shape shape) {
    return total_mass(sample_body(rigid(std::move(shape), 0.07), steel()));
  };
  EXPECT_NEAR(mass_of(BoxShape{{0, 0, 0}, {0.5, 0.4, 0.3}}), 8000 * 0.06, 1e-9);
  EXPECT_NEAR(mass_of(SphereShape{{0, 0, 0}, 0.3}), 8000 * 4 * pi / 3 * 0.027, 1e-9);
  EXPECT_NEAR(mass_of(CylinderShape{{0, 0, 0}, {1, 1, 0}, 0.2, 0.5}), 8000 * pi * 0.02, 1e-9);
  EXPECT_NEAR(mass_of(box_mesh({0, 0, 0}, {0.5, 0.4, 0.3})), 8000 * 0.06, 1e-9);
}

TEST(Sampling, GivesALiquidParticleTheMassOfItsCell) {
  BodyDescription body = rigid(SphereShape{{0, 0, 0}, 0.3}, 0.1);
  body.kind = BodyKind::liquid;
  for (const Real mass : sample_body(body, steel()).masses) EXPECT_DOUBLE_EQ(mass, 8);
}

TEST(Sampling, SharesAGivenMassEqually) {
  BodyDescription body = rigid(BoxShape{{0, 0, 0}, {0.3, 0.3, 0.3}}, 0.1);
  body.mass = 54;
  for (const BodyKind kind : {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid}) {
    body.kind = kind;
    for (const Real mass : sample_body(body, steel()).masses) EXPECT_DOUBLE_EQ(mass, 2);
  }
}

TEST(Sampling, PlacesTurnsAndMovesABody) {
  BodyDescription body = rigid(BoxShape{{1, 0, 0}, {0.4, 0.2, 0.2}}, 0.2);
  body.position = {10, 20, 30};
  body.orientation = Quat(Eigen::AngleAxis<Real>(std::numbers::pi / 2, Vec3::UnitZ()));
  body.velocity = {1, 0, 0};
  body.angular_velocity = {0, 0, 2};
  const SampledBody sample = sample_body(body, steel());
  ASSERT_EQ(sample.positions.size(), 2u);
  EXPECT_TRUE(sample.positions[0].isApprox(Vec3(10, 20.9, 30), 1e-14));
  EXPECT_TRUE(sample.positions[1].isApprox(Vec3(10, 21.1, 30), 1e-14));
  // Velocities are about the centre of mass (10, 21, 30).
  EXPECT_TRUE(sample.velocities[0].isApprox(Vec3(1.2, 0, 0), 1e-14));
  EXPECT_TRUE(sample.velocities[1].isApprox(Vec3(0.8, 0, 0), 1e-14));
}

std::size_t springs_of(const LatticeSprings& springs, Shape shape) {
  BodyDescription body = rigid(std::move(shape), 0.1);
  body.kind = BodyKind::deformable;
  Material material = steel();
  material.springs = springs;
  const SampledBody sample = sample_body(body, material);
  std::set<std::pair<Index, Index>> pairs;
  for (const SampledSpring& spring : sample.springs) {
    EXPECT_NE(spring.a, spring.b);
    EXPECT_TRUE(pairs.insert(std::minmax(spring.a, spring.b)).second) << "duplicate spring";
    const Real distance = (sample.positions[spring.a] - sample.positions[spring.b]).norm();
    EXPECT_NEAR(spring.rest_length, distance, 1e-14);
  }
  return sample.springs.size();
}

TEST(Sampling, JoinsLatticeNeighbours) {
  const SpringConstants constants{100, 1};
  const BoxShape box{{0, 0, 0}, {0.4, 0.3, 0.2}};  // 4 x 3 x 2
  EXPECT_EQ(springs_of({}, box), 0u);
  EXPECT_EQ(springs_of({constants, {}, {}}, box), 3u * 3 * 2 + 4u * 2 * 2 + 4u * 3 * 1);
  // Two diagonals per face of a cell: xy 3*2*2, xz 3*1*3, yz 2*1*4.
  EXPECT_EQ(springs_of({{}, constants, {}}, box), 2u * (12 + 9 + 8));
  EXPECT_EQ(springs_of({{}, {}, constants}, box), 2u * 3 * 2 + 4u * 1 * 2 + 0u);
}

TEST(Sampling, GivesEachKindOfSpringItsLengthAndConstants) {
  BodyDescription body = rigid(BoxShape{{0, 0, 0}, {0.3, 0.3, 0.3}}, 0.1);
  body.kind = BodyKind::deformable;
  Material material = steel();
  material.springs = LatticeSprings{{{1, 10}}, {{2, 20}}, {{3, 30}}};
  for (const SampledSpring& spring : sample_body(body, material).springs) {
    const Real expected[] = {0.1, 0.1 * std::sqrt(2.0), 0.2};
    const auto kind = static_cast<std::size_t>(spring.stiffness) - 1;
    EXPECT_NEAR(spring.rest_length, expected[kind], 1e-14);
    EXPECT_EQ(spring.damping, 10 * spring.stiffness);
  }
}

TEST(Sampling, JoinsNothingAcrossAGap) {
  const SpringConstants constants{100, 1};
  const MeshShape pieces =
      joined(box_mesh({0, 0, 0}, {0.2, 0.1, 0.1}), box_mesh({0.3, 0, 0}, {0.5, 0.1, 0.1}));
  EXPECT_EQ(springs_of({constants, {}, {}}, pieces), 2u);
}

TEST(Sampling, TakesParticlesOneByOne) {
  BodyDescription body;
  body.kind = BodyKind::deformable;
  body.shape = ParticleShape{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                             {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}},
                             {1, 2, 3},
                             {0.1, 0.2, 0.3},
                             {0}};
  body.springs = {{0, 1, {50, 5}, {}}, {1, 2, {60, 6}, 0.5}};
  const SampledBody sample = sample_body(body, steel());
  EXPECT_EQ(sample.masses, (std::vector<Real>{1, 2, 3}));
  EXPECT_EQ(sample.radii, (std::vector<Real>{0.1, 0.2, 0.3}));
  EXPECT_EQ(sample.fixed, std::vector<Index>{0});
  EXPECT_EQ(sample.velocities[0], Vec3::Zero());  // fixed
  EXPECT_EQ(sample.velocities[2], Vec3(3, 3, 3));
  ASSERT_EQ(sample.springs.size(), 2u);
  EXPECT_EQ(sample.springs[0].rest_length, 1);
  EXPECT_EQ(sample.springs[1].rest_length, 0.5);
  EXPECT_EQ(sample.springs[1].stiffness, 60);
}

TEST(Sampling, GivesParticlesWithoutMassesTheBodysMass) {
  BodyDescription body;
  body.kind = BodyKind::rigid;
  body.shape = ParticleShape{{{0, 0, 0}, {1, 0, 0}}, {}, {}, {}, {}};
  body.spacing = 0.1;
  EXPECT_DOUBLE_EQ(sample_body(body, steel()).masses[1], 8);
  EXPECT_DOUBLE_EQ(sample_body(body, steel()).radii[1], 0.05);
  body.mass = 3;
  body.radius = 0.2;
  EXPECT_DOUBLE_EQ(sample_body(body, steel()).masses[1], 1.5);
  EXPECT_DOUBLE_EQ(sample_body(body, steel()).radii[1], 0.2);
}

}  // namespace
}  // namespace vat::sampling_test
