#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "core/sampling/jitter.h"
#include "core/sampling/sampling.h"
#include "tests/support/scenes.h"

/// Effects of fields, jitter and dimensions on the initial state of a body.
namespace vat::test::start_test {
namespace {

Material water() {
  return make_liquid("water", 1000, {50, 1, 0.2});
}

BodyDescription block(BodyKind kind, Shape shape) {
  BodyDescription body{"block", kind, "water", std::move(shape), 0.1};
  return body;
}

BodyDescription turned_block() {
  BodyDescription body = block(BodyKind::liquid, BoxShape{{0, 0, 0}, {0.4, 0.3, 0.5}});
  body.position = {1, -2, 3};
  body.orientation = Quat(0.6, 0, 0.8, 0);
  return body;
}

VectorField wavy_field() {
  VectorField field;
  field.center = {0.5, 0.25, -1};
  field.gradient << 0.1, 0.2, 0.3, -0.4, 0.5, 0.6, 0.7, -0.8, 0.9;
  field.waves = {{{0.5, 0, -0.25}, {2, 3, 0}, 0.75}, {{0, 1, 0}, {0, 0, 4}, 0}};
  return field;
}

/// Evaluates the field component by component.
Vec3 wavy_value(const Vec3& p) {
  const Real x = p.x() - 0.5;
  const Real y = p.y() - 0.25;
  const Real z = p.z() + 1;
  const Real first = std::sin(2 * p.x() + 3 * p.y() + 0.75);
  const Real second = std::sin(4 * p.z());
  return {0.1 * x + 0.2 * y + 0.3 * z + 0.5 * first, -0.4 * x + 0.5 * y + 0.6 * z + second,
          0.7 * x - 0.8 * y + 0.9 * z - 0.25 * first};
}

TEST(Start, VelocityFieldIsAddedAtEveryParticlesPlace) {
  BodyDescription body = turned_block();
  body.velocity = {1, 2, 3};
  body.velocity_field = wavy_field();
  const SampledBody sample = sample_body(body, water());
  ASSERT_EQ(sample.positions.size(), 60U);
  for (std::size_t i = 0; i < sample.positions.size(); ++i) {
    const Vec3 expected = Vec3(1, 2, 3) + wavy_value(sample.positions[i]);
    EXPECT_LT((sample.velocities[i] - expected).norm(), 1e-14);
  }
}

TEST(Start, DisplacementMovesParticlesAndThenVelocitiesAreTaken) {
  const BodyDescription still = turned_block();
  BodyDescription body = still;
  body.displacement_field = wavy_field();
  body.velocity_field = wavy_field();
  const SampledBody before = sample_body(still, water());
  const SampledBody after = sample_body(body, water());
  for (std::size_t i = 0; i < before.positions.size(); ++i) {
    const Vec3 expected = before.positions[i] + wavy_value(before.positions[i]);
    EXPECT_LT((after.positions[i] - expected).norm(), 1e-14);
    EXPECT_LT((after.velocities[i] - wavy_value(after.positions[i])).norm(), 1e-14);
  }
}

BodyDescription spring_bar() {
  ParticleShape shape = make_particles({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 1);
  shape.fixed = {2};
  BodyDescription bar = make_body("bar", BodyKind::deformable, "water", shape, 0.1);
  bar.springs = {{0, 1, {10, 0}, {}}, {1, 2, {10, 0}, 0.5}};
  return bar;
}

TEST(Start, DisplacementStretchesSprings) {
  BodyDescription bar = spring_bar();
  bar.displacement_field.emplace().gradient(0, 0) = 0.25;
  const SampledBody sample = sample_body(bar, water());
  EXPECT_DOUBLE_EQ(sample.positions[1].x(), 1.25);
  EXPECT_DOUBLE_EQ(sample.positions[2].x(), 2.5);
  EXPECT_EQ(sample.springs[0].rest_length, 1);
  EXPECT_EQ(sample.springs[1].rest_length, 0.5);
}

TEST(Start, FixedParticlesGetNoVelocityFromTheField) {
  BodyDescription bar = spring_bar();
  bar.velocity_field.emplace().gradient(1, 0) = 2;
  const SampledBody sample = sample_body(bar, water());
  EXPECT_EQ(sample.velocities[1], Vec3(0, 2, 0));
  EXPECT_EQ(sample.velocities[2], Vec3(0, 0, 0));
}

TEST(Start, JitterShiftsWithinItsBoundAndSpringsRestThere) {
  Material gum = water();
  gum.springs.emplace().structural = SpringConstants{100, 1};
  const BodyDescription still = block(BodyKind::deformable, BoxShape{{0, 0, 0}, {1, 1, 1}});
  BodyDescription body = still;
  body.jitter = 0.25;
  body.seed = 5;
  const SampledBody before = sample_body(still, gum);
  const SampledBody after = sample_body(body, gum);
  ASSERT_EQ(after.positions.size(), 1000U);
  Vec3 sum = Vec3::Zero();
  Vec3 squares = Vec3::Zero();
  for (std::size_t i = 0; i < after.positions.size(); ++i) {
    const Vec3 shift = (after.positions[i] - before.positions[i]) / 0.025;
    EXPECT_LE(shift.cwiseAbs().maxCoeff(), 1 + 1e-12);
    sum += shift / 1000;
    squares += shift.cwiseAbs2() / 1000;
  }
  // A uniform distribution over [-1, 1] has mean 0 and variance 1/3. For 1000 samples, the standard
  // errors are 0.018 and 0.0094 (the fourth moment is 1/5).
  EXPECT_LT(sum.cwiseAbs().maxCoeff(), 4 * 0.0183);
  EXPECT_LT((squares.array() - 1.0 / 3).abs().maxCoeff(), 4 * 0.0094);
  for (const SampledSpring& spring : after.springs) {
    const Vec3 arm = after.positions[spring.a] - after.positions[spring.b];
    EXPECT_DOUBLE_EQ(spring.rest_length, arm.norm());
  }
}

TEST(Start, JitterIsTheSameEverywhereAndDependsOnTheSeed) {
  std::vector<Vec3> points(6, Vec3::Zero());
  jitter(points, 1, 0, 3);
  EXPECT_EQ(points[5], Vec3(-0.3529106409900893, 0.7199704676063186, -0.2426980905925329));
  std::vector<Vec3> others(6, Vec3::Zero());
  jitter(others, 1, 7, 3);
  EXPECT_EQ(others[5], Vec3(-0.10285603996881298, 0.6373331901151882, 0.6125235396050714));
  std::vector<Vec3> plane(6, Vec3::Zero());
  jitter(plane, 1, 7, 2);
  EXPECT_EQ(plane[5], Vec3(others[5].x(), 0, others[5].z()));
}

TEST(Start, OfTwoDimensionsABoxIsALayerAtZero) {
  BodyDescription body = block(BodyKind::liquid, BoxShape{{0, 0, 0}, {0.5, 9, 0.3}});
  body.position = {1, 0, 2};
  body.orientation = Quat(0.6, 0, 0.8, 0);
  body.jitter = 0.5;
  const SampledBody sample = sample_body(body, water(), 2);
  ASSERT_EQ(sample.positions.size(), 15U);
  for (const Vec3& position : sample.positions) EXPECT_EQ(position.y(), 0);
  for (const Real mass : sample.masses) EXPECT_DOUBLE_EQ(mass, 1000 * 0.01);
}

TEST(Start, OfTwoDimensionsASphereIsADisc) {
  BodyDescription body = block(BodyKind::rigid, SphereShape{{0, 0, 0}, 1});
  body.spacing = 0.05;
  const SampledBody sample = sample_body(body, water(), 2);
  for (const Vec3& p : sample.positions) {
    EXPECT_EQ(p.y(), 0);
    EXPECT_LE(p.norm(), 1 + 1e-9);
  }
  // Gauss circle problem: the number of lattice points in a disc is its area, with an error of the
  // order of its rim.
  const auto count = static_cast<Real>(sample.positions.size());
  EXPECT_NEAR(count, std::numbers::pi / (0.05 * 0.05), 0.2 * 2 * std::numbers::pi / 0.05);
  const Real mass = std::accumulate(sample.masses.begin(), sample.masses.end(), Real{0});
  EXPECT_NEAR(mass, 1000 * std::numbers::pi, 1e-9);
}

TEST(Start, OfTwoDimensionsALatticeHasSpringsInThePlane) {
  Material gum = water();
  gum.springs = LatticeSprings{{{100, 1}}, {{50, 1}}, {{20, 1}}};
  const BodyDescription body = block(BodyKind::deformable, BoxShape{{0, 0, 0}, {0.4, 0.4, 0.4}});
  const SampledBody sample = sample_body(body, gum, 2);
  ASSERT_EQ(sample.positions.size(), 16U);
  // 4 x 4 particles: rows of 3 springs in both directions, two diagonals per cell, and second
  // neighbours.
  EXPECT_EQ(sample.springs.size(), 24U + 18U + 16U);
  EXPECT_DOUBLE_EQ(sample.masses[0], 1000 * 0.16 / 16);
}

}  // namespace
}  // namespace vat::test::start_test
