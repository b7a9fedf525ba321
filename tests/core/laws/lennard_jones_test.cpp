#include "core/laws/lennard_jones.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::lennard_jones_test {
namespace {

constexpr Real kStiffness = 300;  // [N/m]
constexpr Real kRest = 0.2;       // [m] l
constexpr Real kWidth = 0.15;     // [m] a
constexpr Real kEnd = kRest + kWidth;

Real push(Real distance) {
  return layer_push(kStiffness, kWidth, kEnd, distance);
}

TEST(LennardJones, RestsWithTheSlopeOfASpring) {
  EXPECT_NEAR(push(kRest), 0, 1e-14 * kStiffness);
  EXPECT_NEAR(layer_slope(kStiffness, kWidth, kEnd, kRest), kStiffness, 1e-10);
  EXPECT_GT(push(0.99 * kRest), 0);
  EXPECT_LT(push(1.01 * kRest), 0);
}

TEST(LennardJones, EndsWithoutAJump) {
  EXPECT_EQ(push(kEnd), 0);
  EXPECT_EQ(layer_slope(kStiffness, kWidth, kEnd, kEnd), 0);
  EXPECT_EQ(layer_energy(kStiffness, kWidth, kEnd, kEnd), 0);
}

// The force of the reference, F(0) (h - r)^2 ((h - r)^2 - (h - l)^2) / (h^2 l (2 h - l)).
TEST(LennardJones, IsTheForceOfItsSource) {
  const Real h = kEnd;
  const Real at_zero = push(0);
  for (const Real r : {0.0, 0.05, 0.1, 0.25, 0.3}) {
    const Real expected = at_zero *
                          (std::pow(h - r, 4) - std::pow(h - kRest, 2) * std::pow(h - r, 2)) /
                          (h * h * kRest * (2 * h - kRest));
    EXPECT_NEAR(push(r), expected, 1e-12 * at_zero) << r;
  }
}

TEST(LennardJones, HasTheStatedPullAndEnergy) {
  Real least = 0;
  for (Real r = kRest; r < kEnd; r += 1e-5) least = std::min(least, push(r));
  EXPECT_NEAR(least, -kStiffness * kWidth / 8, 1e-6);
  EXPECT_NEAR(layer_energy(kStiffness, kWidth, kEnd, kRest), -kStiffness * kWidth * kWidth / 15,
              1e-12);
}

TEST(LennardJones, DerivesFromItsEnergyAndItsSlopeFromIt) {
  constexpr Real kDelta = 1e-6;
  for (const Real r : {0.01, 0.1, 0.19, 0.22, 0.3, 0.34}) {
    const auto energy = [](Real at) { return layer_energy(kStiffness, kWidth, kEnd, at); };
    EXPECT_NEAR(push(r), -(energy(r + kDelta) - energy(r - kDelta)) / (2 * kDelta), 1e-6) << r;
    const Real slope = -(push(r + kDelta) - push(r - kDelta)) / (2 * kDelta);
    EXPECT_NEAR(layer_slope(kStiffness, kWidth, kEnd, r), slope, 1e-5) << r;
    EXPECT_LE(std::abs(slope), greatest_layer_slope(kStiffness, kWidth, kEnd, r) + 1e-5) << r;
  }
}

Scene make_layer_scene(Real distance, BodyKind first, BodyKind second) {
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, 1e-3,
                 {make_liquid("a", 1000, {0, 0, 0.1}), make_liquid("b", 1000, {0, 0, 0.1})});
  scene.default_interface = {
      .stiffness = kStiffness, .law = InterfaceLaw::lennard_jones, .reach = kEnd / kRest};
  scene.bodies = {make_body("first", first, "a", make_particles({{0, 0, 0}}, 1), kRest / 2),
                  make_body("second", second, "b", make_particles({{0, 0.6, 0.8}}, 2), kRest / 2)};
  std::get<ParticleShape>(scene.bodies[1].shape).positions[0] *= distance;
  return scene;
}

TEST(LennardJones, JoinsBodiesOfAllKinds) {
  for (const BodyKind first : kBodyKinds) {
    for (const BodyKind second : kBodyKinds) {
      for (const Real distance : {0.1, 0.3}) {
        const ForceProbe probe(make_layer_scene(distance, first, second));
        EXPECT_EQ(probe.force(0), Vec3(-probe.force(1)));
        EXPECT_LT((probe.force(0) + push(distance) * Vec3(0, 0.6, 0.8)).norm(), 1e-12) << distance;
      }
      EXPECT_EQ(ForceProbe(make_layer_scene(1.01 * kEnd, first, second)).force(0), Vec3::Zero());
    }
  }
}

TEST(LennardJones, LoadsParticlesWithTheSlopeThatTheyAreAt) {
  const auto load = [](Real distance) {
    const Scene scene = make_layer_scene(distance, BodyKind::rigid, BodyKind::rigid);
    return ForceProbe(scene).work().of<ContactForceScratch>().contact_loads[0].stiffness;
  };
  EXPECT_NEAR(load(0.1), 2 * layer_slope(kStiffness, kWidth, kEnd, 0.1), 1e-9);
  EXPECT_NEAR(load(0.3), 2 * kStiffness, 1e-9);  // the slope is smaller under tension than at rest
}

TEST(LennardJones, HoldsParticlesToWalls) {
  Scene scene = make_layer_scene(1, BodyKind::deformable, BodyKind::deformable);
  scene.bodies.resize(1);
  scene.bodies[0].radius = kRest;
  scene.vat = Vat{{-3, -3, -0.3}, {3, 3, 3}, false, {}, {}};
  EXPECT_LT((ForceProbe(scene).force(0) - push(0.3) * Vec3::UnitZ()).norm(), 1e-12);
  scene.vat->min.z() = -0.1;
  EXPECT_LT((ForceProbe(scene).force(0) - push(0.1) * Vec3::UnitZ()).norm(), 1e-12);
}

/// Returns the sum of kinetic and contact energy.
Real energy_of(const Simulation& simulation) {
  const Diagnostics now = simulation.diagnostics();
  return now.kinetic_energy + now.contact_energy;
}

TEST(LennardJones, KeepsEnergyAndMomentumInAllControls) {
  // Verlet's energy error is dt^2 (v U'' v / 12 - |U'|^2 / 24 m). Here U'' / m is at most 1.5 times
  // the slope at 0.15 m, and m v^2 is twice the depth of the well.
  const Real steepest = 1.5 * layer_slope(kStiffness, kWidth, kEnd, 0.15);
  const Real sway = 1e-6 * steepest / 6 * kStiffness * kWidth * kWidth / 15;
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    Scene scene = make_layer_scene(0.3, BodyKind::deformable, BodyKind::rigid);
    scene.numerics.control = control;
    Simulation simulation = make_simulation(scene);
    const Real before = energy_of(simulation);
    EXPECT_NEAR(before, layer_energy(kStiffness, kWidth, kEnd, 0.3), 1e-12);
    Real nearest = 1;
    for (int n = 0; n < 1000; ++n) {
      advance_to(simulation, simulation.time() + 1e-3);
      nearest = std::min(nearest, (position_of(simulation, 0) - position_of(simulation, 1)).norm());
      EXPECT_NEAR(energy_of(simulation), before, sway) << to_string(control);
    }
    EXPECT_LT(nearest, 0.95 * kRest);  // it oscillates through the rest distance
    const Vec3 momentum = velocity_of(simulation, 0) + 2 * velocity_of(simulation, 1);
    EXPECT_LT(momentum.norm(), 1e-13);
  }
}

}  // namespace
}  // namespace vat::test::lennard_jones_test
