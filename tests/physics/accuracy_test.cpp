#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/mixed_scenes.h"

// Scenes that request an accuracy.

namespace vat::accuracy_test {
namespace {

using namespace test;

constexpr std::array<Real, 5> kAccuracies = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6};

Scene make_accurate(Scene scene, Real accuracy) {
  scene.numerics.accuracy = accuracy;
  scene.numerics.tick = 0.02;
  return scene;
}

Simulation run(const Scene& scene, Real time) {
  Simulation simulation = make_simulation(scene);
  const AdvanceReport report =
      simulation.advance(static_cast<std::uint32_t>(std::lround(time / simulation.step_size())));
  EXPECT_EQ(report.undone_steps, 0U);
  EXPECT_NEAR(simulation.time(), time, 1e-12 * time);
  return simulation;
}

/// A particle on a spring that is attached to the origin.
Scene make_swing(const Vec3& start, Real stiffness) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.materials = {make_material("steel")};
  BodyDescription body = make_body("swing", BodyKind::deformable, "steel",
                                   make_particles({Vec3::Zero(), start}, 1), 0.01);
  body.springs = {{0, 1, {stiffness, 0}, 1.0}};
  std::get<ParticleShape>(body.shape).fixed = {0};
  scene.bodies = {body};
  return scene;
}

// DEF-1: 100 radians.
TEST(Accuracy, IsMetByAnOscillator) {
  std::set<IntegratorId> used;
  for (const Real accuracy : kAccuracies) {
    const Simulation end = run(make_accurate(make_swing({1.2, 0, 0}, 100), accuracy), 10);
    EXPECT_LT(std::abs(position_of(end, 0, 1).x() - 1.1724637744575), 0.2 * accuracy) << accuracy;
    used.insert(end.scene().numerics.integrator);
  }
  EXPECT_TRUE(used.contains(IntegratorId::runge_kutta_4));
}

/// DEF-5: 11 x 3 x 3 masses on axial and diagonal springs, fixed at x = 0.
Scene make_cantilever() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("rubber")};
  std::vector<Vec3> points;
  std::vector<Index> held;
  for (int x = 0; x < 11; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 3; ++z) {
        if (x == 0) held.push_back(static_cast<Index>(points.size()));
        points.push_back(0.1 * Vec3(x, y, z));
      }
    }
  }
  BodyDescription body =
      make_body("beam", BodyKind::deformable, "rubber", make_particles(points, 0.01), 0.01);
  body.springs = join_near(points, 0.15, {1000, 0});
  for (SpringDescription& spring : body.springs) {
    if ((points[spring.a] - points[spring.b]).norm() < 0.11) spring.constants.stiffness = 2000;
  }
  std::get<ParticleShape>(body.shape).fixed = held;
  scene.bodies = {body};
  return scene;
}

TEST(Accuracy, IsMetByACantilever) {
  const Scene scene = make_cantilever();
  EXPECT_EQ(scene.bodies[0].springs.size(), 550U);
  for (const Real accuracy : kAccuracies) {
    const Simulation end = run(make_accurate(scene, accuracy), 0.5);
    const Real tip = position_of(end, 0, 10 * 9 + 4).z();
    EXPECT_LT(std::abs(tip - 0.1003714490), 0.0847 * accuracy) << accuracy;
  }
}

// RIG-4: contacts are not smooth, so steps are adaptive.
TEST(Accuracy, OfBodiesThatMayTouchNeedsAdaptiveSteps) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("steel")};
  scene.interfaces = {{{"steel", kVatMaterial}, {1e4, 0}, 0.1}};
  scene.vat = Vat{Vec3(-50, -50, 0), Vec3(50, 50, 50), false, {}};
  scene.bodies = {
      make_body("ball", BodyKind::rigid, "steel", make_particles({{0, 0, 1.1}}, 1), 1e-6)};
  for (const Real accuracy : {1e-2, 1e-3, 1e-4}) {
    const Simulation end = run(make_accurate(scene, accuracy), 0.94);
    EXPECT_EQ(end.scene().numerics.control, StepControl::adaptive);
    EXPECT_EQ(end.scene().numerics.integrator, IntegratorId::velocity_verlet);
    const Real exact = 1 - 9.81 / 2 * std::pow(0.94 - 0.934906080799, 2);
    EXPECT_LT(std::abs(position_of(end, 0).z() - 0.1 - exact), accuracy) << accuracy;
  }
}

TEST(Accuracy, ThatNeedsTooManyStepsIsAnError) {
  const Scene scene = make_accurate(make_swing({1.2, 0, 0}, 1e12), 1e-8);
  const Result<Simulation> result = Simulation::create(scene);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.errors().at(0).path, "/numerics/accuracy");
}

TEST(Accuracy, DoesNotChangeTheStepsOfARunInProgress) {
  Simulation simulation = make_simulation(make_accurate(make_swing({1.2, 0, 0}, 100), 1e-3));
  const Real step = simulation.step_size();
  BodyDescription stiff = make_swing({1.2, 0, 0}, 1e6).bodies[0];
  stiff.name = "stiff";
  stiff.position = {0, 9, 0};
  ASSERT_TRUE(simulation.add_body(stiff));
  EXPECT_EQ(simulation.step_size(), step);
}

}  // namespace
}  // namespace vat::accuracy_test
