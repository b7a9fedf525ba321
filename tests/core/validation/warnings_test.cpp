#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/numerics/contact_limits.h"
#include "core/numerics/cost_estimate.h"
#include "core/validation/validate.h"
#include "tests/support/scenes.h"

namespace vat::warnings_test {
namespace {

/// "code path", one a line, of all warnings but that of run time: scenes here are of any size.
std::string warnings_of(const Scene& scene) {
  EXPECT_TRUE(find_errors(scene).empty());
  std::string found;
  for (const Warning& warning : find_warnings(scene)) {
    if (warning.code == "slow") continue;
    found += (found.empty() ? "" : "\n") + warning.code + ' ' + warning.path;
  }
  return found;
}

Scene two_balls(Real distance) {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials.emplace_back();
  scene.materials[0].name = "wood";
  const SphereShape ball{{0, 0, 0}, 0.1};
  scene.bodies = {{"a", BodyKind::rigid, "wood", ball, 0.05},
                  {"b", BodyKind::rigid, "wood", ball, 0.05}};
  scene.bodies[1].position = {distance, 0, 0};
  return scene;
}

/// A mass on a spring to a fixed point: omega^2 = stiffness / 1 kg.
Scene oscillator(Real stiffness, Real damping) {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials.emplace_back();
  scene.materials[0].name = "m";
  scene.bodies.resize(1);
  scene.bodies[0].name = "pair";
  scene.bodies[0].kind = BodyKind::deformable;
  scene.bodies[0].material = "m";
  scene.bodies[0].shape = ParticleShape{{{0, 0, 0}, {1, 0, 0}}, {}, {1, 1}, {0.1, 0.1}, {0}};
  scene.bodies[0].springs = {{0, 1, {stiffness, damping}, {}}};
  return scene;
}

TEST(Warnings, AreOfTheStepThatAnAccuracyChooses) {
  Scene scene = oscillator(1e8, 0);
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  scene.numerics.accuracy = 0.1;
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(Warnings, OfBodiesThatOverlap) {
  EXPECT_EQ(warnings_of(two_balls(0.2)), "");
  EXPECT_EQ(warnings_of(two_balls(0.12)), "bodies_overlap /bodies/1");
}

TEST(Warnings, OfBodiesInAWall) {
  Scene scene = two_balls(1);
  scene.vat = Vat{{-0.09, -1, -1}, {2, 1, 1}, false, {}};
  EXPECT_EQ(warnings_of(scene), "wall_overlap /bodies/0");
  scene.vat->min.x() = -0.1;  // touches
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(Warnings, OfWallsThatAreThereOnly) {
  Scene scene = two_balls(0.3);
  scene.vat = Vat{{-0.09, -1, -1}, {2, 1, 1}, false, {}, {}};
  scene.periodic = Periodicity{{-0.09, 0, 0}, {2, 0, 0}, {true, false, false}};
  EXPECT_EQ(warnings_of(scene), "");
  scene.periodic.reset();
  scene.forces.walls = false;
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(Warnings, OfNoContactWhereThereIsNone) {
  Scene scene = two_balls(0.12);
  scene.forces.contacts = false;
  EXPECT_EQ(warnings_of(scene), "");
}

/// A cube of liquid of the gas.
Scene pool(const LiquidConstants& liquid, Real size = 1) {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials = {test::make_liquid("water", 1000, liquid)};
  scene.bodies = {
      {"pool", BodyKind::liquid, "water", BoxShape{Vec3::Zero(), Vec3::Constant(size)}, 0.05}};
  return scene;
}

/// A cube of water, 40 particles along each edge.
Scene sea(Real step) {
  Scene scene = pool({1, 1, 0.1}, 2);
  scene.numerics.step = step;
  scene.numerics.tick = 0.1;
  return scene;
}

// It is 1.95 m deep: 10 g H is 191 m^2/s^2.
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

TEST(CostEstimate, AddsUpWhatBodiesNeed) {
  const auto cost = [](const Scene& scene) {
    const SampledBody body = sample_body(scene.bodies[0], scene.materials[0]);
    const SampledBody* pointer = &body;
    return estimate_cost(scene, {&pointer, 1});
  };
  Scene scene = sea(0.001);
  const CostEstimate once = cost(scene);
  scene.numerics.integrator = IntegratorId::runge_kutta_4;
  EXPECT_DOUBLE_EQ(cost(scene).seconds, 4 * once.seconds);
  scene.numerics.step = 0.002;
  EXPECT_DOUBLE_EQ(cost(scene).seconds, 2 * once.seconds);
  EXPECT_EQ(cost(scene).memory, once.memory);
}

TEST(CostEstimate, GoesByTheNeighboursOfALiquid) {
  const auto cost = [](const Scene& scene) {
    const std::vector<SampledBody> bodies = sample_bodies(scene);
    return estimate_cost(scene, pointers_to(bodies)).seconds;
  };
  Scene scene = sea(0.001);
  const Real once = cost(scene);
  LiquidConstants& liquid = *scene.materials[0].liquid;
  liquid.support_radius *= 2;
  EXPECT_NEAR(cost(scene), 8 * once, 1e-9 * once);
  liquid.surface_tension = 0.1;
  EXPECT_NEAR(cost(scene), 24 * once, 1e-9 * once);
  scene.surface_model = SurfaceModel::cohesion;
  EXPECT_NEAR(cost(scene), 40 * once, 1e-9 * once);
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
  scene.materials.push_back(test::make_liquid("water", 1000, {100, 0, 0.1}));
  scene.bodies.push_back(test::make_body("drop", BodyKind::liquid, "water",
                                         test::make_particles({{0, 0.5, 0}}, 0.1), 0.05));
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

TEST(Warnings, OfWhatThePressureSolverDoesNotUse) {
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

TEST(Warnings, OfAStepBeyondTheSpringsLimit) {
  // The bound is omega^2 <= 2 k / m, so at dt = 1 ms Verlet is safe up to k = 2 m / dt^2 = 2e6.
  EXPECT_EQ(warnings_of(oscillator(1.99e6, 0)), "");
  EXPECT_EQ(warnings_of(oscillator(2.01e6, 0)), "unstable_step /numerics/step");
}

TEST(Warnings, OfIntegratorsThatMakeUndampedSpringsGrow) {
  Scene scene = oscillator(100, 0);
  scene.numerics.integrator = IntegratorId::heun;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  EXPECT_EQ(warnings_of(oscillator(100, 0)), "");
  scene.bodies[0].springs[0].constants.damping = 1;
  EXPECT_EQ(warnings_of(scene), "");
}

/// With an integrator that takes damping at the velocity half a step before.
Scene with_late_damping(Scene scene) {
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  return scene;
}

TEST(Warnings, OfDampedSpringsBeyondTheStep) {
  // 2 c / m dt = 2 is the limit: c = 1000 N s/m at 1 ms. Velocity Verlet has none.
  EXPECT_EQ(warnings_of(with_late_damping(oscillator(1, 990))), "");
  EXPECT_EQ(warnings_of(with_late_damping(oscillator(1, 1010))), "unstable_step /numerics/step");
  EXPECT_EQ(warnings_of(oscillator(1, 1010)), "");
  // Explicit Euler: dt <= c / k.
  Scene scene = oscillator(1000, 1.01);
  scene.numerics.integrator = IntegratorId::explicit_euler;
  EXPECT_EQ(warnings_of(scene), "");
  scene.bodies[0].springs[0].constants.damping = 0.99;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
}

/// Two rigid particles of 1 kg, so that one contact has mu = 1/2.
Scene two_grains(const InterfaceConstants& contact) {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials.emplace_back();
  scene.materials[0].name = "wood";
  scene.bodies.resize(2);
  for (std::size_t b = 0; b < 2; ++b) {
    scene.bodies[b] = {"grain " + std::to_string(b), BodyKind::rigid, "wood",
                       ParticleShape{{{static_cast<Real>(b), 0, 0}}, {}, {1}, {0.1}, {}}, 0};
  }
  scene.default_interface = contact;
  return scene;
}

TEST(Warnings, OfStiffContacts) {
  // omega^2 = k / mu: dt = 1 ms is stable up to k = 4 mu / dt^2 = 2e6.
  EXPECT_EQ(warnings_of(two_grains({1.99e6, 0})), "");
  EXPECT_EQ(warnings_of(two_grains({2.01e6, 0})), "unstable_step /numerics/step");
  Scene scene = two_grains({1e9, 0});
  scene.interfaces = {{{"wood", "wood"}, {1000, 1}, {}}};  // takes the default's place
  EXPECT_EQ(warnings_of(scene), "");
  scene.interfaces[0].constants.stiffness = 2.01e6;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  scene.bodies.pop_back();  // one body alone touches nothing
  EXPECT_EQ(warnings_of(scene), "");
}

TEST(Warnings, OfDampedContacts) {
  // 2 c / mu dt <= 4: c <= 1000 N s/m.
  EXPECT_EQ(warnings_of(with_late_damping(two_grains({0, 990}))), "");
  EXPECT_EQ(warnings_of(with_late_damping(two_grains({0, 1010}))), "unstable_step /numerics/step");
}

TEST(Warnings, OfContactsThatNoStepHolds) {
  Scene scene = two_grains({1000, 0});
  for (const IntegratorId integrator : {IntegratorId::heun, IntegratorId::explicit_euler}) {
    scene.numerics.integrator = integrator;
    EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
    EXPECT_THAT(find_warnings(scene)[0].message, testing::HasSubstr("no step is short enough"));
  }
}

TEST(Warnings, OfManyContactsOfOneBody) {
  // 64 contacts at once on 8 kg: omega^2 = 64 k / m, so k <= 4 m / (64 dt^2) = 5e5.
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.materials.emplace_back();
  scene.materials[0].name = "m";
  scene.vat = Vat{{-1, -1, 0}, {1, 1, 2}, false, {}};
  scene.bodies = {{"slab", BodyKind::rigid, "m", BoxShape{{0, 0, 0}, {0.4, 0.4, 0.05}}, 0.05}};
  scene.bodies[0].position = {0, 0, 0.03};
  scene.interfaces = {{{"m", "vat"}, {4.9e5, 0}, {}}};
  EXPECT_EQ(warnings_of(scene), "");
  scene.interfaces[0].constants.stiffness = 5.1e5;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  scene.bodies[0].orientation = Quat(Eigen::AngleAxis<Real>(0.3, Vec3(1, 2, 3).normalized()));
  scene.bodies[0].position.z() = 0.5;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
}

TEST(Warnings, CountTheParticlesOfTheFlattestSide) {
  const auto count = [](Shape shape) {
    BodyDescription body{"b", BodyKind::rigid, "m", std::move(shape), 0.1};
    return count_flattest_side(sample_body(body, Material{}), Quat::Identity());
  };
  EXPECT_EQ(count(BoxShape{{0, 0, 0}, {0.5, 0.4, 0.3}}), 20u);
  EXPECT_EQ(count(BoxShape{{0, 0, 0}, {0.1, 0.1, 0.9}}), 9u);
  EXPECT_EQ(count(ParticleShape{{{0, 0, 0}}, {}, {1}, {1}, {}}), 1u);
  // A plane that is not the axes': the principal axes find it.
  const Vec3 u = Vec3(1, 2, 3).normalized();
  const Vec3 v = u.cross(Vec3::UnitX()).normalized();
  ParticleShape plane;
  for (int i = 0; i < 20; ++i) plane.positions.push_back((i % 5) * u + (i / 5) * v);
  EXPECT_EQ(count(plane), 20u);
}

TEST(Warnings, OfMotionTooFastForTheStep) {
  Scene scene = two_grains({1000, 1});
  scene.bodies[0].angular_velocity = {0, 0, 490};
  EXPECT_EQ(warnings_of(scene), "");
  scene.bodies[0].angular_velocity = {0, 0, 510};
  EXPECT_EQ(warnings_of(scene), "turns_too_fast /bodies/0/angular_velocity");
  scene.bodies[0].angular_velocity.setZero();
  scene.bodies[1].velocity = {0, 199, 0};  // touch at 0.2 m, 1 ms
  EXPECT_EQ(warnings_of(scene), "");
  scene.bodies[1].velocity = {0, 201, 0};
  EXPECT_EQ(warnings_of(scene), "too_fast /bodies/1/velocity");
  scene.bodies.erase(scene.bodies.begin());  // alone it can go as fast as it likes
  EXPECT_EQ(warnings_of(scene), "");
  scene.vat = Vat{{-9, -9, -9}, {9, 9, 9}, true, {}};
  scene.bodies[0].velocity = {0, 101, 0};  // a wall is touched at 0.1 m
  EXPECT_EQ(warnings_of(scene), "too_fast /bodies/0/velocity");
}

TEST(Warnings, OfSoundAndViscosityBeyondTheStep) {
  // c dt / h <= 0.96: c <= 96 m/s with h = 0.1 m and dt = 1 ms.
  Scene scene = pool({95.0 * 95, 1, 0.1});
  EXPECT_EQ(warnings_of(scene), "");
  scene.materials[0].liquid->stiffness = 97.0 * 97;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
  // nu dt / h^2 <= 0.126: mu <= 1260 Pa s.
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  scene.materials[0].liquid = LiquidConstants{1e-6, 1250, 0.1};
  EXPECT_EQ(warnings_of(scene), "");
  scene.materials[0].liquid->viscosity = 1270;
  EXPECT_EQ(warnings_of(scene), "unstable_step /numerics/step");
}

TEST(Warnings, NameIdleSettingsOfSurfaces) {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-4);
  scene.pressure_solver = PressureSolver::tait;
  LiquidConstants water{100, 1, 0.12};
  scene.materials = {test::make_liquid("water", 1000, water), test::make_material("stone"),
                     test::make_material("wood")};
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
}  // namespace vat::warnings_test
