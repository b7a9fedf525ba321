#include <gtest/gtest.h>

#include "core/numerics/step_limits.h"
#include "core/validation/validate.h"
#include "tests/support/edited_scene.h"
#include "tests/support/errors.h"
#include "tests/support/name_of.h"
#include "tests/support/scenes.h"

// Deformable bodies that become liquid.

namespace vat::test::melting_test {
namespace {

constexpr Real kSpacing = 0.1;
constexpr Real kStep = 1e-3;

/// A jelly of 4 x 4 x 4 particles above a rigid plate. One particle is fixed. The jelly turns and
/// deforms.
Scene make_melting_scene(PressureSolver solver) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, kStep);
  scene.pressure_solver = solver;
  scene.gravity = {0, 0, -10};
  scene.materials = {make_material("jelly", 900),
                     make_liquid("water", 1000, {.stiffness = 100, .support_radius = 0.25}),
                     make_material("wood", 500)};
  const std::vector<Vec3> points = make_lattice(4, 4, 4, kSpacing);
  BodyDescription jelly =
      make_body("jelly", BodyKind::deformable, "jelly", make_particles(points, 0.9), kSpacing / 2);
  std::get<ParticleShape>(jelly.shape).fixed = {5};
  jelly.springs = join_near(points, 1.1 * kSpacing, {500, 1});
  jelly.position = {0, 0, 0.5};
  jelly.angular_velocity = {1, 2, 3};
  BodyDescription plate =
      make_body("plate", BodyKind::rigid, "wood",
                make_particles(make_lattice(5, 5, 1, kSpacing), 0.5), kSpacing / 2);
  scene.bodies = {plate, jelly};
  return scene;
}

class Melts : public testing::TestWithParam<PressureSolver> {};

TEST_P(Melts, KeepingPlacesVelocitiesAndMassesToTheBit) {
  Simulation simulation = make_advanced(make_melting_scene(GetParam()), 20);
  const BodyId id = *simulation.find_body("jelly");
  const BodyView before = *simulation.find_body(id);
  const auto positions = copy_of(before.positions);
  const auto velocities = copy_of(before.velocities);
  const auto masses = copy_of(before.masses);
  const Diagnostics solid = simulation.diagnostics();
  ASSERT_GT(solid.elastic_energy, 0);
  ASSERT_TRUE(simulation.melt_body(id, "water").ok());
  const BodyView after = *simulation.find_body(id);
  EXPECT_EQ(after.kind, BodyKind::liquid);
  EXPECT_EQ(after.material, "water");
  EXPECT_EQ(copy_of(after.positions), positions);
  EXPECT_EQ(copy_of(after.velocities), velocities);
  EXPECT_EQ(copy_of(after.masses), masses);
  EXPECT_EQ(simulation.spring_count(), 0U);
  const Diagnostics liquid = simulation.diagnostics();
  EXPECT_EQ(liquid.elastic_energy, 0);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(liquid.bodies[b].linear_momentum, solid.bodies[b].linear_momentum);
    EXPECT_EQ(liquid.bodies[b].angular_momentum, solid.bodies[b].angular_momentum);
  }
  simulation.advance(1);
  EXPECT_NE(simulation.find_body(id)->positions[5],
            positions[5]);  // the particle is no longer fixed
}

TEST_P(Melts, AtATimeAsByCommandThen) {
  Scene scene = make_melting_scene(GetParam());
  Simulation commanded = make_simulation(scene);
  scene.bodies[1].melting = Melting{"water", 20 * kStep};
  Simulation timed = make_simulation(scene);
  EXPECT_FALSE(timed.advance(20).bodies_changed);
  EXPECT_EQ(timed.bodies()[1].kind, BodyKind::deformable);
  EXPECT_TRUE(timed.advance(30).bodies_changed);
  EXPECT_EQ(timed.bodies()[1].kind, BodyKind::liquid);
  commanded.advance(20);
  ASSERT_TRUE(commanded.melt_body(*commanded.find_body("jelly"), "water").ok());
  commanded.advance(30);
  EXPECT_EQ(timed.state_hash(), commanded.state_hash());
}

TEST_P(Melts, AgainAfterARestore) {
  Scene scene = make_melting_scene(GetParam());
  scene.bodies[1].melting = Melting{"water", 20 * kStep};
  Simulation simulation = make_advanced(scene, 10);
  const Snapshot solid = simulation.snapshot();
  simulation.advance(30);
  const std::uint64_t melted = simulation.state_hash();
  simulation.restore(solid);
  EXPECT_EQ(simulation.bodies()[1].kind, BodyKind::deformable);
  simulation.advance(30);
  EXPECT_EQ(simulation.state_hash(), melted);
}

TEST_P(Melts, DuringGrabsWhichEnd) {
  Scene scene = make_melting_scene(GetParam());
  scene.bodies[1].melting = Melting{"water", 2 * kStep};
  Simulation simulation = make_simulation(scene);
  const BodyId plate = *simulation.find_body("plate");
  const BodyId jelly = *simulation.find_body("jelly");
  ASSERT_TRUE(simulation.grab_start(7, plate, 3, Vec3::Zero()).ok());
  ASSERT_TRUE(simulation.grab_start(8, jelly, 3, Vec3::Zero()).ok());
  EXPECT_TRUE(simulation.advance(2).ended_grabs.empty());
  EXPECT_EQ(simulation.advance(2).ended_grabs, std::vector<std::uint64_t>{8});
  EXPECT_TRUE(simulation.grab_move(7, Vec3::UnitX()).ok());
  EXPECT_EQ(simulation.grab_move(8, Vec3::UnitX()).errors()[0].code, "no_such_grab");
}

INSTANTIATE_TEST_SUITE_P(Solvers, Melts, testing::Values(PressureSolver::gas, PressureSolver::tait),
                         NameOf());

// If the guard ends a call, the state returns to that before the call's events.
TEST(Melting, InACallThatFailsIsUndone) {
  Scene scene = make_melting_scene(PressureSolver::tait);
  scene.bodies[1].melting = Melting{"water", 5 * kStep};
  Simulation simulation = make_advanced(scene, 3);
  // After about 40 steps the plate is too fast for the guard.
  ASSERT_TRUE(simulation.apply_force(*simulation.find_body("plate"), {0, 0, -3e5}, 1).ok());
  const std::uint64_t hash = simulation.state_hash();
  const AdvanceReport report = simulation.advance(100);
  ASSERT_TRUE(report.failed);
  ASSERT_GT(report.steps - report.undone_steps, 10U);  // the body had melted
  EXPECT_FALSE(report.bodies_changed);
  EXPECT_EQ(simulation.bodies()[1].kind, BodyKind::deformable);
  EXPECT_EQ(simulation.state_hash(), hash);
}

TEST(Melting, RefusesBodiesThatCannotMelt) {
  Simulation simulation = make_simulation(make_melting_scene(PressureSolver::tait));
  const BodyId jelly = *simulation.find_body("jelly");
  const std::uint64_t hash = simulation.state_hash();
  EXPECT_EQ(errors_of(simulation.melt_body(77, "water")), "no_such_body /body");
  EXPECT_EQ(errors_of(simulation.melt_body(*simulation.find_body("plate"), "water")),
            "not_allowed /body");
  EXPECT_EQ(errors_of(simulation.melt_body(jelly, "steam")), "unknown_name /material");
  EXPECT_EQ(errors_of(simulation.melt_body(jelly, "wood")), "not_liquid /material");
  EXPECT_EQ(simulation.state_hash(), hash);
  ASSERT_TRUE(simulation.melt_body(jelly, "water").ok());
  EXPECT_EQ(errors_of(simulation.melt_body(jelly, "water")), "not_allowed /body");
}

TEST(Melting, LimitsStepsByTheLiquidToBe) {
  Scene scene = make_melting_scene(PressureSolver::tait);
  const auto limit_at = [&](const char* path) {
    for (const StepLimit& limit : find_step_limits(scene, sample_bodies(scene))) {
      if (limit.path == path) return limit.step;
    }
    return std::numeric_limits<Real>::infinity();
  };
  EXPECT_EQ(limit_at("/bodies/1/melting"), std::numeric_limits<Real>::infinity());
  scene.bodies[1].melting = Melting{"water", 1};
  const Real wanted = limit_at("/bodies/1/melting");
  scene.bodies[1].kind = BodyKind::liquid;
  scene.bodies[1].material = "water";
  scene.bodies[1].melting.reset();
  EXPECT_EQ(wanted, limit_at("/bodies/1"));
  EXPECT_LT(wanted, 0.05);
}

}  // namespace
}  // namespace vat::test::melting_test
