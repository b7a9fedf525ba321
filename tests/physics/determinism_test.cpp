#include <gtest/gtest.h>

#include "tests/support/mixed_scenes.h"
#include "tests/support/thread_runner.h"

namespace vat::determinism_test {
namespace {

using namespace test;

constexpr std::uint32_t kSteps = 12;

/// Bodies of several blocks of work each, in contact with the floor and one another from the start.
Scene make_scene_of(std::initializer_list<BodyKind> kinds, IntegratorId integrator) {
  Scene scene = make_two_material_scene(integrator, 1e-3, 1);
  scene.gravity = {0, 0, -9.81};
  scene.vat = Vat{Vec3(-0.25, -0.25, -0.21), Vec3(1, 1, 1.3), true, SlideMotion{{1, 0, 0}, 0.2, 2}};
  int n = 0;
  for (const BodyKind kind : kinds) {
    scene.bodies.push_back(make_block("body" + std::to_string(n), kind, n % 2 == 0 ? "a" : "b", 9,
                                      Vec3(0.02, 0.03, 0.43 * n), {0.3, 0.1, n == 0 ? 0 : -1.0}));
    ++n;
  }
  return scene;
}

std::uint64_t run(const Scene& scene, TaskRunner* runner) {
  Simulation simulation = make_simulation(scene, runner);
  EXPECT_GT(simulation.diagnostics().contact_energy, 0);
  const AdvanceReport report = simulation.advance(kSteps);
  EXPECT_TRUE(report.events.empty());
  return simulation.state_hash();
}

void expect_same_bits(std::initializer_list<BodyKind> kinds) {
  std::vector<std::uint64_t> hashes;
  for (const IntegratorId integrator : kIntegrators) {
    const Scene scene = make_scene_of(kinds, integrator);
    const std::uint64_t serial = run(scene, nullptr);
    for (const std::size_t threads : {1u, 2u, 3u, 4u}) {
      ThreadRunner runner(threads);
      EXPECT_EQ(run(scene, &runner), serial) << to_string(integrator) << ", " << threads;
      EXPECT_EQ(runner.runs() > 0, threads > 1);
    }
    EXPECT_EQ(std::ranges::count(hashes, serial), 0) << "two methods give the same bits";
    hashes.push_back(serial);
  }
}

TEST(Determinism, OfLiquid) {
  expect_same_bits({BodyKind::liquid});
}
TEST(Determinism, OfTwoLiquids) {
  expect_same_bits({BodyKind::liquid, BodyKind::liquid});
}
TEST(Determinism, OfDeformableBodies) {
  expect_same_bits({BodyKind::deformable, BodyKind::deformable});
}
TEST(Determinism, OfRigidBodies) {
  expect_same_bits({BodyKind::rigid, BodyKind::rigid});
}
TEST(Determinism, OfAllKinds) {
  expect_same_bits({BodyKind::liquid, BodyKind::deformable, BodyKind::rigid});
}

TEST(Determinism, DoesNotDependOnHowStepsAreGrouped) {
  const Scene scene = make_scene_of({BodyKind::liquid, BodyKind::deformable, BodyKind::rigid},
                                    IntegratorId::velocity_verlet);
  Simulation one = make_simulation(scene);
  Simulation many = make_simulation(scene);
  one.advance(kSteps);
  for (std::uint32_t n = 0; n < kSteps; ++n) {
    many.advance(1);
    many.diagnostics();  // looking changes nothing
    many.advance(0);
  }
  EXPECT_EQ(one.state_hash(), many.state_hash());
}

TEST(Determinism, OfTwoSimulationsSideBySide) {
  const Scene first = make_scene_of({BodyKind::liquid, BodyKind::rigid}, IntegratorId::heun);
  const Scene second =
      make_scene_of({BodyKind::deformable, BodyKind::rigid}, IntegratorId::velocity_verlet);
  const std::uint64_t first_alone = run(first, nullptr);
  const std::uint64_t second_alone = run(second, nullptr);
  Simulation a = make_simulation(first);
  Simulation b = make_simulation(second);
  for (std::uint32_t n = 0; n < kSteps; ++n) {
    a.advance(1);
    b.advance(1);
  }
  EXPECT_EQ(a.state_hash(), first_alone);
  EXPECT_EQ(b.state_hash(), second_alone);
}

}  // namespace
}  // namespace vat::determinism_test
