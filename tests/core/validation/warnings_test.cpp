// Warnings of overlaps, of run time and of settings without effect.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/numerics/cost_estimate.h"
#include "core/validation/validate.h"
#include "tests/core/validation/warned_scenes.h"
#include "tests/support/scenes.h"

namespace vat::test::warnings_test {
namespace {

TEST(Warnings, OfBodiesThatOverlap) {
  EXPECT_EQ(warnings_of(two_balls(0.2)), "");
  Scene scene = two_balls(0.12);
  EXPECT_EQ(warnings_of(scene), "bodies_overlap /bodies/1");
  scene.forces.contacts = false;
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(Warnings, OfBodiesInAWall) {
  Scene scene = two_balls(1);
  scene.vat = Vat{{-0.1, -1, -1}, {2, 1, 1}, false, {}};
  EXPECT_EQ(warnings_of(scene), "");  // touches
  scene.vat->min.x() = -0.09;
  EXPECT_EQ(warnings_of(scene), "wall_overlap /bodies/0");
  scene.periodic = Periodicity{{-0.09, 0, 0}, {2, 0, 0}, {true, false, false}};
  EXPECT_EQ(warnings_of(scene), "") << "no wall on a periodic axis";
  scene.periodic.reset();
  scene.forces.walls = false;
  EXPECT_EQ(warnings_of(scene), "");
}

/// A cube of water, 40 particles along each edge.
Scene sea(Real step) {
  Scene scene = pool({1, 1, 0.1}, 2);
  scene.numerics.step = step;
  scene.numerics.tick = 0.1;
  return scene;
}

// The depth is 1.95 m: 10 g H is 191 m^2/s^2.
TEST(Warnings, OfALiquidTooSoftForItsWeight) {
  Scene scene = sea(0.01);
  scene.pressure_solver = PressureSolver::tait;
  const char* const path = "soft_liquid /materials/0/liquid/stiffness";
  scene.materials[0].liquid->stiffness = 200;
  EXPECT_THAT(warnings_of(scene), testing::Not(testing::HasSubstr(path)));
  scene.materials[0].liquid->stiffness = 180;
  EXPECT_THAT(warnings_of(scene), testing::HasSubstr(path));
}

TEST(Warnings, OfRunTime) {
  const auto is_slow = [](const Scene& scene) {
    return std::ranges::any_of(find_warnings(scene), [](const Warning& warning) {
      return warning.code == "slow" && warning.path == "/numerics/step";
    });
  };
  EXPECT_FALSE(is_slow(sea(0.1)));
  EXPECT_TRUE(is_slow(sea(0.001)));
}

CostEstimate cost(const Scene& scene) {
  const std::vector<SampledBody> bodies = sample_bodies(scene);
  return estimate_cost(scene, pointers_to(bodies));
}

TEST(CostEstimate, AddsTheCostsOfBodies) {
  Scene scene = sea(0.001);
  const CostEstimate once = cost(scene);
  scene.numerics.integrator = IntegratorId::runge_kutta_4;
  EXPECT_DOUBLE_EQ(cost(scene).seconds, 4 * once.seconds);
  scene.numerics.step = 0.002;
  EXPECT_DOUBLE_EQ(cost(scene).seconds, 2 * once.seconds);
  EXPECT_EQ(cost(scene).memory, once.memory);
}

TEST(CostEstimate, GoesByTheNeighboursOfALiquid) {
  Scene scene = sea(0.001);
  LiquidConstants& liquid = *scene.materials[0].liquid;
  const Real support_radius = liquid.support_radius;
  liquid.support_radius = 1e-6 * support_radius;
  const Real alone = cost(scene).seconds;
  const auto of_neighbours = [&] { return cost(scene).seconds - alone; };
  liquid.support_radius = support_radius;
  const Real once = of_neighbours();
  ASSERT_GT(once, 0);
  const Real tolerance = 1e-9 * (alone + once);
  liquid.support_radius *= 2;
  EXPECT_NEAR(of_neighbours(), 8 * once, tolerance);
  liquid.surface_tension = 0.1;
  EXPECT_NEAR(of_neighbours(), 24 * once, tolerance);
  scene.surface_model = SurfaceModel::cohesion;
  EXPECT_NEAR(of_neighbours(), 40 * once, tolerance);
}

TEST(CostEstimate, GoesByThePressureSolver) {
  Scene scene = sea(0.001);
  std::vector<Real> costs;
  for (const auto solver :
       {PressureSolver::tait, PressureSolver::gas, PressureSolver::incompressible}) {
    scene.pressure_solver = solver;
    costs.push_back(cost(scene).seconds);
  }
  EXPECT_LT(costs[0], costs[1]);
  EXPECT_LT(costs[1], costs[2]);
}

TEST(Warnings, OfATolerance) {
  Scene scene = oscillator(1, 0);
  EXPECT_EQ(warnings_of(scene), "");
  scene.numerics.tolerance = 1e-3;
  EXPECT_EQ(warnings_of(scene), "no_effect /numerics/tolerance");
  scene.numerics.control = StepControl::adaptive;
  EXPECT_EQ(warnings_of(scene), "");
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  EXPECT_EQ(warnings_of(scene), "no_effect /numerics/tolerance");
  scene.numerics.integrator = IntegratorId::velocity_verlet;
  scene.numerics.control = StepControl::local;
  EXPECT_EQ(warnings_of(scene), "no_effect /numerics/tolerance");
}

TEST(Warnings, OfSubSteps) {
  Scene scene = oscillator(1, 0);
  scene.bodies[0].sub_steps = 4;
  EXPECT_EQ(warnings_of(scene), "no_effect /bodies/0/sub_steps");
  scene.numerics.control = StepControl::local;
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(Warnings, OfSettingsWithoutEffect) {
  Scene scene = two_balls(0.3);
  scene.vat = Vat{{-1, -1, -1}, {2, 1, 1}, true, {}, {}};
  scene.vat->walls[0].no_slip = true;
  scene.vat->walls[5].velocity = {1, 0, 0};
  scene.bodies[1].seed = 3;
  EXPECT_EQ(warnings_of(scene),
            "no_effect /vat/walls/x_min/no_slip\nno_effect /vat/walls/z_max/velocity\nno_effect "
            "/bodies/1/seed");
  scene.default_interface = {0, 1, 0.5};
  EXPECT_EQ(warnings_of(scene),
            "no_effect /vat/walls/x_min/no_slip\nno_effect /default_interface/friction\nno_effect "
            "/bodies/1/seed");
  scene = two_balls(0.3);
  scene.central_field = CentralField{{0, 0, 0}, 1};
  EXPECT_EQ(warnings_of(scene), "");
  scene.forces.gravity = false;
  EXPECT_EQ(warnings_of(scene), "no_effect /central_field");
  scene.central_field.reset();
  scene.settling = Settling{1, 1};
  EXPECT_EQ(warnings_of(scene), "no_effect /settling");
  scene.settling.reset();
  scene.sleeping = Sleeping{};
  EXPECT_EQ(warnings_of(scene), "");
  scene.vat = Vat{{-1, -1, -1}, {1, 1, 1}, true, SlideMotion{}, {}};
  EXPECT_THAT(warnings_of(scene), testing::Not(testing::HasSubstr("no_effect /sleeping")));
  scene.vat->motion->stroke = 0.1;
  EXPECT_THAT(warnings_of(scene), testing::HasSubstr("no_effect /sleeping"));
  scene.vat.reset();
  scene.sleeping.reset();
  scene.incompressible.most_iterations = 50;
  EXPECT_EQ(warnings_of(scene), "no_effect /incompressible");
}

TEST(Warnings, OfLawsThatALiquidOfTaitDoesNotHave) {
  Scene scene = two_balls(0.3);
  scene.materials.push_back(make_liquid("water", 1000, {100, 0, 0.1}));
  scene.bodies.push_back(
      make_body("drop", BodyKind::liquid, "water", make_particles({{0, 0.5, 0}}, 0.1), 0.05));
  scene.vat = Vat{{-1, -1, -1}, {2, 1, 1}, true, {}, {}};
  scene.interfaces = {
      {{"water", "vat"}, {.stiffness = 10, .law = InterfaceLaw::lennard_jones}, {}}};
  const auto idle = testing::HasSubstr("no_effect /interfaces/0/law");
  EXPECT_THAT(warnings_of(scene), testing::Not(idle));
  scene.pressure_solver = PressureSolver::tait;
  EXPECT_THAT(warnings_of(scene), idle);
  scene.interfaces[0].constants.law = InterfaceLaw::sph;
  EXPECT_THAT(warnings_of(scene), testing::Not(idle));
}

TEST(Warnings, OfConstantsThatThePressureSolverIgnores) {
  Scene scene = two_balls(1);
  scene.printed_pressure_force = true;
  scene.kernel = KernelId::cubic_spline;
  scene.pair_precision = PairPrecision::double_precision;
  scene.pressure_solver = PressureSolver::tait;
  EXPECT_EQ(warnings_of(scene), "no_effect /printed_pressure_force");
  scene.pressure_solver = PressureSolver::gas;
  EXPECT_EQ(warnings_of(scene), "no_effect /kernel\nno_effect /pair_precision");
}

TEST(Warnings, OfNoSlipForALiquidThatIsNotViscous) {
  Scene scene = pool({10, 1, 0.1}, 0.5);
  scene.vat = Vat{{-1, -1, -1}, {1, 1, 1}, true, {}, {}};
  scene.vat->walls[4].no_slip = true;
  EXPECT_EQ(warnings_of(scene), "");
  scene.forces.viscosity = false;
  EXPECT_EQ(warnings_of(scene), "no_effect /vat/walls/z_min/no_slip");
}

TEST(Warnings, OfASupportRadiusThatDoesNotFitTheSpacing) {
  Scene scene = pool({100, 1, 0.1});
  EXPECT_EQ(warnings_of(scene), "");
  scene.bodies[0].spacing = 0.1;
  EXPECT_EQ(warnings_of(scene), "support_radius /bodies/0/spacing");
}

TEST(Warnings, OfADeformableBodyWithoutSprings) {
  Scene scene = two_balls(1);
  scene.bodies[0].kind = BodyKind::deformable;
  EXPECT_EQ(warnings_of(scene), "no_springs /bodies/0");
}

TEST(Warnings, NameIdleSettingsOfSurfaces) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-4);
  scene.pressure_solver = PressureSolver::tait;
  LiquidConstants water{100, 1, 0.12};
  scene.materials = {make_liquid("water", 1000, water), make_material("stone"),
                     make_material("wood")};
  scene.bodies = {{"drop", BodyKind::liquid, "water", SphereShape{Vec3::Zero(), 0.1}, 0.04}};
  scene.surface_model = SurfaceModel::cohesion;
  InterfaceDescription wet;
  wet.materials = {"stone", "water"};
  wet.contact_angle = 60;
  InterfaceDescription dry = wet;
  dry.materials = {"stone", "wood"};
  scene.interfaces = {wet, dry};
  EXPECT_EQ(warnings_of(scene),
            "no_effect /surface_tension_model\nno_effect /interfaces/0/contact_angle\nno_effect "
            "/interfaces/1/contact_angle");
  scene.materials[0].liquid->surface_tension = 0.07;
  EXPECT_EQ(warnings_of(scene), "no_effect /interfaces/1/contact_angle");
}

}  // namespace
}  // namespace vat::test::warnings_test
