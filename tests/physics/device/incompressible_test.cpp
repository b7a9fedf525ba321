#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/physics/device/on_device.h"
#include "tests/support/scenes.h"

// Incompressible liquids on an OpenCL device.

namespace vat::device_incompressible_test {
namespace {

using namespace test;

constexpr Real kSpacing = 0.02;
constexpr Real kGravity = 9.81;

/// A column of water that is narrower than its vat, so that it collapses.
Scene make_column() {
  Scene scene = make_scene(IntegratorId::symplectic_euler, 2e-3);
  scene.pressure_solver = PressureSolver::incompressible;
  scene.gravity = {0, 0, -kGravity};
  scene.materials = {make_liquid("water", 1000, {0, 0.01, 2 * kSpacing})};
  scene.vat = Vat{{0, 0, 0}, {0.3, 0.12, 0.4}, false, {}};
  scene.bodies = {BodyDescription{"column", BodyKind::liquid, "water",
                                  BoxShape{{0.08, 0.06, 0.12}, {0.16, 0.12, 0.24}}, kSpacing}};
  return scene;
}

/// Adds a velocity field that strains the column at these rates [1/s].
void set_strain(Scene& scene, const Vec3& rates) {
  VectorField field;
  field.center = std::get<BoxShape>(scene.bodies[0].shape).center;
  field.gradient.diagonal() = rates;
  scene.bodies[0].velocity_field = field;
}

/// The column with steps that step control chooses. Its corner falls on the floor.
Scene make_adaptive() {
  Scene scene = make_column();
  scene.numerics.step = scene.numerics.tick = 0.02;
  scene.numerics.control = StepControl::adaptive;
  scene.materials[0].liquid->viscosity = 0;
  scene.bodies[0].position = {0.01, 0, 0.05};
  return scene;
}

const SceneCase kScenes[] = {
    {"honey between no-slip walls that move",
     [](Scene& scene) {
       scene.materials[0].liquid->viscosity = 1;
       set_no_slip(scene);
     }},
    {"cubic spline", [](Scene& scene) { scene.kernel = KernelId::cubic_spline; }},
    {"drop that is squeezed without a vat and gravity",
     [](Scene& scene) {
       scene.vat.reset();
       scene.forces.gravity = false;
       set_strain(scene, Vec3(1, 1, -3));
     }},
    {"more neighbours than a list has",
     [](Scene& scene) { scene.materials[0].liquid->support_radius = 4.2 * kSpacing; }},
    {"over-dense at the start",
     [](Scene& scene) {
       std::get<BoxShape>(scene.bodies[0].shape) = {{0.075, 0.06, 0.12}, {0.16, 0.12, 0.24}};
     }},
};

// Both compute sums over pairs in single precision. The device adds the terms in sequence, the CPU
// in up to 16 lanes. The rounding error grows with the square root of the number of terms in
// sequence, so that the ratio is at most 4. The residuals of the solves are far smaller.
TEST(IncompressibleDevice, HasTheAccuracyOfTheCpu) {
  constexpr std::uint32_t kSteps = 15;
  constexpr Real kRatio = 4;
  Scene scene = make_column();
  scene.incompressible.divergence_tolerance = 1e-7;
  expect_accuracy_of_cpu(scene, kCommonScenes, kSteps, kRatio);
  expect_accuracy_of_cpu(scene, kScenes, kSteps, kRatio);
}

TEST(IncompressibleDevice, ChoosesTheStepsOfTheCpu) {
  expect_adaptive_steps_of_cpu(make_adaptive(), 12);
}

// The nominal step does not resolve the viscosity, but the weight of the liquid shortens all steps.
TEST(IncompressibleDevice, TakesAdaptiveStepsThatResolveTheViscosity) {
  Scene scene = make_adaptive();
  scene.materials[0].liquid->viscosity = 0.1;
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  const AdvanceReport report = device.advance(4);
  EXPECT_EQ(report.device_steps, 4U);
  EXPECT_EQ(report.steps, cpu.advance(4).steps);
  EXPECT_LT(difference(device, cpu), 1e-3 * kSpacing);
}

// The probe of the first step finds a motion that the other limits do not see.
TEST(IncompressibleDevice, ProbesTheFirstStep) {
  Scene scene = make_adaptive();
  scene.vat.reset();
  scene.forces.gravity = false;
  set_strain(scene, Vec3(1, 1, -2));
  scene.settling = Settling{20, 1};
  scene.numerics.tolerance = 1e-4;
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  const AdvanceReport report = device.advance(1);
  const AdvanceReport expected = cpu.advance(1);
  EXPECT_EQ(report.steps, expected.steps);
  EXPECT_EQ(report.force_evaluations, report.steps + 2);
  EXPECT_NEAR(report.least_step, expected.least_step, 1e-9);
  EXPECT_LT(report.least_step, report.greatest_step / 1.5);
}

// The pressure in a liquid at rest is rho g (H - z). The error is that of case LIQ-3i.
TEST(IncompressibleDevice, CarriesTheWeightOfTheLiquid) {
  constexpr Real kDepth = 0.5;
  Scene scene = make_column();
  scene.dimensions = 2;
  scene.numerics.step = scene.numerics.tick = 2.5e-3;
  scene.settling = Settling{20, 0.5};
  scene.materials = {make_liquid("water", 1000, {0, 0.1, 0.05})};
  scene.vat = Vat{{0, -1, 0}, {0.2, 1, 1}, false, {}};
  scene.bodies = {BodyDescription{"water", BodyKind::liquid, "water",
                                  BoxShape{{0.1, 0, kDepth / 2}, {0.2, 1, kDepth}}, 0.025}};
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(240).device_steps, 240U);
  const BodyId water = device.bodies()[0].id;
  Real error2 = 0;
  Real scale2 = 0;
  for (int sample = 0; sample < 20; ++sample) {
    EXPECT_EQ(device.advance(5).device_steps, 5U);
    const std::vector<Real> pressure = device.liquid_fields(water).value().pressure;
    const std::span<const Vec3> positions = device.bodies()[0].positions;
    for (std::size_t i = 0; i < pressure.size(); ++i) {
      const Real exact = 1000 * kGravity * (kDepth - positions[i].z());
      error2 += (pressure[i] - exact) * (pressure[i] - exact);
      scale2 += exact * exact;
    }
  }
  EXPECT_LT(std::sqrt(error2 / scale2), 0.06);
}

// The force on a fixed ball in a liquid at rest is the weight of the displaced liquid. The
// tolerance is that of case INT-5.
TEST(IncompressibleDevice, LiftsAFixedBodyByTheWeightOfTheDisplacedLiquid) {
  constexpr Real kRadius = 4 * kSpacing;
  const Vec3 center(0.16, 0, 0.14);
  Scene scene = make_column();
  scene.dimensions = 2;
  scene.numerics.step = scene.numerics.tick = 2.5e-3;
  scene.settling = Settling{20, 0.4};
  scene.materials.push_back(make_material("stone", 2000));
  scene.vat = Vat{{0, -1, 0}, {0.32, 1, 0.6}, false, {}};
  std::vector<Vec3> points;
  for (const Vec3& point : make_lattice(16, 1, 15, kSpacing)) {
    const Vec3 p = point + Vec3(0.16, 0, 0.15);
    if ((p - center).norm() > kRadius + kSpacing / 4) points.push_back(p);
  }
  scene.bodies = {make_fixed("disc", SphereShape{center, kRadius}, kSpacing),
                  make_body("water", BodyKind::liquid, "water",
                            make_particles(points, 1000 * kSpacing * kSpacing), kSpacing / 2)};
  Simulation device = make_on_device(scene);
  EXPECT_EQ(device.advance(180).device_steps, 180U);
  Real lift = 0;
  constexpr int kSamples = 20;
  for (int sample = 0; sample < kSamples; ++sample) {
    EXPECT_EQ(device.advance(4).device_steps, 4U);
    lift += device.diagnostics().bodies[0].outer_force.z() / kSamples;
  }
  const Real area = device.diagnostics().bodies[0].mass / 2000;
  EXPECT_NEAR(lift / (1000 * kGravity * area), 1, 0.05);
}

TEST(IncompressibleDevice, KeepsTheDensityWithinItsTolerance) {
  constexpr Real kRounding = 40 * 6e-8;  // of a sum over a neighbourhood
  for (const bool is_adaptive : {false, true}) {
    const Scene scene = is_adaptive ? make_adaptive() : make_column();
    const Real tolerance = scene.incompressible.density_tolerance;
    Simulation device = make_on_device(scene);
    int shifts = 0;
    for (int n = 0; n < 12; ++n) {
      const std::uint32_t steps = is_adaptive ? 1 : 8;
      EXPECT_EQ(device.advance(steps).device_steps, steps);
      const Diagnostics now = device.diagnostics();
      EXPECT_LT(now.mean_density_error, tolerance + kRounding) << n;
      EXPECT_LT(now.max_density_error, 36 * tolerance + kRounding) << n;
      EXPECT_NEAR(now.volume->places.mean, now.mean_density_error, kRounding) << n;
      EXPECT_NEAR(now.volume->places.greatest, now.max_density_error, kRounding) << n;
      shifts += now.volume->places.iterations;
    }
    EXPECT_GT(shifts, 0) << "positions are corrected";
  }
}

// Walls are inelastic for incompressible liquids.
TEST(IncompressibleDevice, StopsParticlesAtWalls) {
  Scene scene = make_column();
  scene.gravity = Vec3::Zero();
  scene.bodies.clear();
  // The particles are beyond a wall after one step.
  const std::vector<Vec3> positions = {{0.001, 0.06, 0.2}, {0.299, 0.06, 0.1}, {0.1, 0.001, 0.001}};
  const std::vector<Vec3> velocities = {{-3, 1, 0}, {3, 0, 1}, {0, -3, -4}};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    ParticleShape shape = make_particles({positions[i]}, 8e-3);
    scene.bodies.push_back(
        make_body("particle " + std::to_string(i), BodyKind::liquid, "water", shape, 0.01));
    scene.bodies.back().velocity = velocities[i];
  }
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  EXPECT_EQ(device.advance(1).wall_stops, 2U) << "the third particle stops before the wall";
  EXPECT_EQ(cpu.advance(1).wall_stops, 2U);
  const Real unit = std::ldexp(2 * kSpacing, -23);  // of positions in sums over pairs
  for (std::size_t body = 0; body < positions.size(); ++body) {
    const Real rounding = 8 * std::ldexp(1.0, -24) * velocities[body].norm();
    EXPECT_LT((velocity_of(device, body) - velocity_of(cpu, body)).norm(), rounding);
    EXPECT_LT((position_of(device, body) - position_of(cpu, body)).norm(),
              rounding * scene.numerics.step + unit);
    EXPECT_LT(velocity_of(device, body).norm(), velocities[body].norm() / 2);
  }
}

TEST(IncompressibleDevice, HasTheSameBitsInAnyPortionsOfSteps) {
  for (const Scene& scene : {make_column(), make_adaptive()}) {
    Simulation one = make_on_device(scene);
    Simulation other = make_on_device(scene);
    one.advance(12);
    for (int n = 0; n < 4; ++n) other.advance(n % 2 == 0 ? 2 : 4);
    EXPECT_EQ(one.state_hash(), other.state_hash());
    const Snapshot middle = one.snapshot();
    one.advance(6);
    const std::uint64_t end = one.state_hash();
    const VolumeReport volume = one.diagnostics().volume.value();
    one.restore(middle);
    EXPECT_EQ(one.advance(6).device_steps, 6U);
    EXPECT_EQ(one.state_hash(), end);
    EXPECT_EQ(one.diagnostics().volume->velocities.mean, volume.velocities.mean);
  }
}

TEST(IncompressibleDevice, ContinuesAStateOfTheCpuAndTheReverse) {
  for (const Scene& scene : {make_column(), make_adaptive()}) {
    Simulation cpu = make_simulation(scene);
    cpu.advance(4);
    Simulation device = Simulation::from(cpu.snapshot());
    EXPECT_EQ(device.state_hash(), cpu.state_hash());
    ASSERT_TRUE(device.set_engine(make_device()).ok());
    EXPECT_EQ(device.advance(4).device_steps, 4U);
    cpu.advance(4);
    EXPECT_LT(difference(device, cpu), 1e-3 * kSpacing);
    Simulation back = Simulation::from(device.snapshot());
    EXPECT_EQ(back.state_hash(), device.state_hash());
    EXPECT_EQ(back.advance(4).device_steps, 0U);
    device.advance(4);
    EXPECT_LT(difference(back, device), 1e-2 * kSpacing);
  }
}

// Each operation is rounded as IEEE 754 defines it, so that the hash is a constant.
TEST(IncompressibleDevice, HasTheSameBitsOnEveryDeviceIfExact) {
  Simulation fixed = make_on_device(make_column());
  EXPECT_EQ(fixed.advance(60).device_steps, 60U);
  EXPECT_EQ(fixed.state_hash(), 0x595cbe8b542a12e3U);
  Scene with_solids = make_column();
  add_fixed_bodies(with_solids);
  Simulation wet = make_on_device(with_solids);
  EXPECT_EQ(wet.advance(30).device_steps, 30U);
  EXPECT_EQ(wet.state_hash(), 0xc8775204430fcbe2U);
  Simulation adaptive = make_on_device(make_adaptive());
  EXPECT_EQ(adaptive.advance(12).device_steps, 12U);
  EXPECT_EQ(adaptive.state_hash(), 0xd325ddef2423cfe6U);
}

TEST(IncompressibleDevice, LeavesAFailedStepToTheCpu) {
  struct Case {
    const char* name;
    std::uint32_t steps;
    Vec3 velocity;
  };
  // The greatest speed is half a support radius per step, 10 m/s.
  const Case cases[] = {{"too fast", 3, {0, 0, 12}},
                        {"too fast after the last step", 1, {0, 0, -9.99}},
                        {"too fast after a step but the first", 2, {0, 0, -9.97}}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_column();
    scene.vat->max.z() = 4;
    scene.bodies[0].position = {0, 0, 2};
    scene.bodies[0].velocity = one.velocity;
    expect_steps_of_cpu(scene, one.steps);
  }
}

TEST(IncompressibleDevice, RestoresTheStateBeforeAFailedStep) {
  Scene fixed = make_column();
  fixed.vat->max.z() = 4;
  fixed.bodies[0].position = {0, 0, 2};
  fixed.bodies[0].velocity = {0, 0, -9.97};  // the greatest speed is 10 m/s
  expect_restored_state(fixed, 1, 2);
  Scene adaptive = make_adaptive();
  // The integer positions of the device end at 64 support radii, 0.57 m above the column.
  adaptive.bodies[0].position.z() = 64 * 2 * kSpacing - 0.57 - 0.23;
  adaptive.bodies[0].velocity = {0, 0, 19};
  expect_restored_state(adaptive, 1, 2);
}

// The solves of the device and of the CPU meet the same tolerance.
TEST(IncompressibleDevice, SolvesForStrongViscosity) {
  constexpr std::uint32_t kSteps = 30;
  const SceneCase cases[] = {
      {"in a slip vat", [](Scene&) {}},
      {"settling between no-slip walls that move",
       [](Scene& scene) {
         set_no_slip(scene);
         scene.settling = Settling{20, 1};
       }},
      {"on fixed bodies in a sliding vat",
       [](Scene& scene) {
         add_fixed_bodies(scene);
         scene.vat->motion = SlideMotion{{1, 0, 0}, 0.1, 0.2};
       }},
  };
  for (const SceneCase& one : cases) {
    SCOPED_TRACE(one.name);
    Scene scene = make_column();
    scene.materials[0].liquid->viscosity = 200;
    one.edit(scene);
    expect_damping_of_cpu(scene, kSteps, kSteps + 1);
  }
}

// Some of the steps resolve the viscosity, and others need a solve.
TEST(IncompressibleDevice, SolvesForStrongViscosityInAdaptiveSteps) {
  Scene scene = make_adaptive();
  scene.materials[0].liquid->viscosity = 20;
  Simulation device = make_on_device(scene);
  Simulation cpu = make_simulation(scene);
  const AdvanceReport report = device.advance(12);
  const AdvanceReport expected = cpu.advance(12);
  EXPECT_EQ(report.device_steps, 12U);
  EXPECT_EQ(report.steps, expected.steps);
  EXPECT_GT(report.iterations.damping, 0U);
  EXPECT_EQ(report.iterations.damping, expected.iterations.damping);
  EXPECT_LT(difference(device, cpu), 1e-3 * kSpacing);
}

TEST(IncompressibleDevice, RefusesFeaturesThatItLacks) {
  const SceneCase cases[] = {
      {"/forces/pressure", [](Scene& s) { s.forces.pressure = false; }},
      {"/numerics/control", [](Scene& s) { s.numerics.control = StepControl::local; }},
      {"/emitters", [](Scene& s) { s.emitters.push_back(make_tap_into(s.bodies[0].name)); }},
      {"/central_field",
       [](Scene& s) {
         s.vat.reset();
         s.central_field = CentralField{{0.1, 0.1, 0.1}, 1};
       }},
      {"/materials",
       [](Scene& s) {
         s.materials[0].liquid->surface_tension = 0.07;
         s.materials[0].liquid->support_radius = 2.5 * kSpacing;
       }},
  };
  expect_refusals(make_column(), cases);
}

}  // namespace
}  // namespace vat::device_incompressible_test
