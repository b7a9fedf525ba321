#include "core/solid/implicit_springs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/validation/validate.h"
#include "tests/support/errors.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"
#include "tests/support/totals.h"

namespace vat::test::implicit_springs_test {
namespace {

constexpr Real kSpacing = 0.05;
constexpr Real kMass = 0.125;

Scene make_implicit_scene(Real step) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, step, {make_material("rubber")});
  scene.materials[0].implicit_springs = true;
  return scene;
}

/// A block of 4 x 3 x 3 particles that rotates and translates. Its particles also move against one
/// another.
Scene make_block(const SpringConstants& constants, Real step) {
  Scene scene = make_implicit_scene(step);
  ParticleShape shape = make_particles(make_lattice(4, 3, 3, kSpacing), kMass);
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    const auto x = static_cast<Real>(i);
    shape.velocities.push_back(Vec3(1, 2, 3).cross(shape.positions[i]) + Vec3(0.1, 0, 0) +
                               0.3 * Vec3(std::sin(x), std::cos(2 * x), std::sin(3 * x)));
  }
  scene.bodies = {make_body("block", BodyKind::deformable, "rubber", shape, 0.02)};
  const auto& positions = std::get<ParticleShape>(scene.bodies[0].shape).positions;
  scene.bodies[0].springs = join_near(positions, 1.5 * kSpacing, constants);
  return scene;
}

/// A mass on a spring of length 1 along x, displaced by `stretch`.
Scene make_oscillator(const SpringConstants& constants, Real step, Real stretch) {
  Scene scene = test::make_oscillator(IntegratorId::velocity_verlet, step, constants, 1 + stretch);
  scene.materials[0].implicit_springs = true;
  return scene;
}

struct Motion {
  Real energy;
  Vec3 momentum;
  Vec3 angular_momentum;
};

Motion motion_of(const Simulation& simulation) {
  const Diagnostics now = simulation.diagnostics();
  return {now.kinetic_energy + now.elastic_energy, now.bodies[0].linear_momentum,
          now.bodies[0].angular_momentum};
}

TEST(ImplicitSprings, LoseEnergyByDashpotsUntilTheBodyTurnsAsOne) {
  for (const Real damping : {1e-5, 1e-3, 1.0}) {  // relative to the stiffness [s]
    for (const Real step : {1e-3, 2e-2}) {
      Simulation simulation = make_simulation(make_block({1e6, 1e6 * damping}, step));
      const Motion start = motion_of(simulation);
      Real last = start.energy;
      for (int n = 0; n < 300; ++n) {
        simulation.advance(1);
        const Real energy = motion_of(simulation).energy;
        ASSERT_LE(energy, last * (1 + 8 * kSpringTolerance)) << damping << ' ' << step << ' ' << n;
        last = energy;
      }
      // At this stiffness the body is rigid: E = P^2 / 2 M + L I^-1 L / 2 about its centre.
      const BodyView body = simulation.bodies()[0];
      Mat3 inertia = Mat3::Zero();
      const Vec3 center = simulation.diagnostics().bodies[0].center_of_mass;
      for (const Vec3& position : body.positions) {
        const Vec3 x = position - center;
        inertia += kMass * (x.squaredNorm() * Mat3::Identity() - x * x.transpose());
      }
      const Vec3 spin = start.angular_momentum - center.cross(start.momentum);
      const Real rigid =
          start.momentum.squaredNorm() / (2 * 36 * kMass) + spin.dot(inertia.inverse() * spin) / 2;
      EXPECT_NEAR(last / rigid, 1, 1e-3) << damping << ' ' << step;
    }
  }
}

TEST(ImplicitSprings, DampUnresolvedOscillationsAtOnce) {
  Simulation simulation = make_simulation(make_oscillator({1e8, 100}, 0.01, 0.01));
  simulation.advance(
      20);  // omega dt = 100, rate dt = 1: an undamped rounding error would oscillate
  EXPECT_LT(std::abs(position_of(simulation, 0, 1).x() - 1), 1e-4);
  EXPECT_LT(velocity_of(simulation, 0, 1).norm(), 0.1);
}

TEST(ImplicitSprings, HangAsStaticsSay) {
  Scene scene = make_oscillator({1e6, 1e4}, 0.02, 0);
  scene.gravity = {9.81, 0, 0};
  Simulation simulation = make_advanced(scene, 200);
  EXPECT_NEAR((position_of(simulation, 0, 1).x() - 1) / (9.81 / 1e6), 1, 1e-6);
  EXPECT_EQ(position_of(simulation, 0, 0), Vec3::Zero());
}

TEST(ImplicitSprings, HaveTheSameBitsForAnyThreads) {
  Scene scene = make_block({1e5, 10}, 0.01);
  ParticleShape shape = make_particles(make_lattice(10, 10, 10, kSpacing), kMass);
  shape.velocities.assign(1000, Vec3(0, 0, -1));
  for (std::size_t i = 0; i < 1000; i += 7) shape.velocities[i].x() = 1;
  scene.bodies[0].shape = shape;
  scene.bodies[0].springs = join_near(shape.positions, 1.5 * kSpacing, {1e5, 10});
  expect_same_bits(scene, 2, 2);
}

TEST(ImplicitSprings, LeaveOtherBodiesAsTheyAre) {
  Scene scene = make_block({200, 1}, 1e-3);
  scene.materials.push_back(make_material("gum"));
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "other";
  scene.bodies[1].material = "gum";
  scene.bodies[1].position = {10, 0, 0};
  Simulation both = make_simulation(scene);
  scene.bodies.erase(scene.bodies.begin());
  Simulation alone = make_simulation(scene);
  both.advance(50);
  alone.advance(50);
  EXPECT_EQ(both.bodies()[0].name, "block");
  for (std::size_t i = 0; i < 36; ++i) {
    EXPECT_EQ(position_of(both, 1, i), position_of(alone, 0, i));
  }
}

TEST(ImplicitSprings, StayInThePlane) {
  Scene scene = make_block({1e6, 1}, 0.02);
  scene.dimensions = 2;
  ParticleShape shape = make_particles(make_lattice(5, 1, 4, kSpacing), kMass);
  for (std::size_t i = 0; i < 20; ++i) shape.velocities.push_back({0, 0, i % 3 == 0 ? 1.0 : 0.0});
  scene.bodies[0].springs = join_near(shape.positions, 1.5 * kSpacing, {1e6, 1});
  scene.bodies[0].shape = shape;
  Simulation simulation = make_advanced(scene, 100);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(position_of(simulation, 0, i).y(), 0);
}

TEST(ImplicitSprings, PushApartTwoParticlesInOnePlace) {
  Scene scene = make_implicit_scene(1e-3);
  scene.bodies = {make_body("pair", BodyKind::deformable, "rubber",
                            make_particles({{0, 0, 0}, {0, 0, 0}}, 1), 0.02)};
  scene.bodies[0].springs = {{0, 1, {100, 0}, 1}};
  Simulation simulation = make_simulation(scene);
  const Real energy = motion_of(simulation).energy;
  simulation.advance(100);
  EXPECT_GT((position_of(simulation, 0, 0) - position_of(simulation, 0, 1)).norm(), 0.1);
  EXPECT_NEAR(motion_of(simulation).energy / energy, 1,
              0.01);  // the first force is that at the start
}

TEST(ImplicitSprings, LimitNoStep) {
  Scene scene = make_block({1e8, 1e3}, 0.02);
  EXPECT_TRUE(find_warnings(scene).empty());
  scene.numerics.control = StepControl::adaptive;
  Simulation simulation = make_simulation(scene);
  EXPECT_EQ(simulation.advance(10).greatest_step, 0.02);
  scene.materials[0].implicit_springs = false;
  scene.numerics.control = StepControl::fixed;
  EXPECT_FALSE(find_warnings(scene).empty());
}

TEST(ImplicitSprings, NeedVelocityVerlet) {
  Scene scene = make_block({1e3, 0}, 1e-3);
  EXPECT_TRUE(find_errors(scene).empty());
  scene.numerics.integrator = IntegratorId::runge_kutta_4;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /numerics/integrator");
  scene.numerics.accuracy = 1e-6;  // selects the integrator
  EXPECT_TRUE(find_errors(scene).empty());
  EXPECT_EQ(make_simulation(scene).scene().numerics.integrator, IntegratorId::velocity_verlet);
  scene.numerics = {IntegratorId::velocity_verlet, 1e-3, 1e-3, StepControl::local};
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /numerics/control");
}

// A factor solves the equations of a free body. Its momentum and energy are those of the theory,
// up to rounding errors of about 1e-16 k dt^2 / m = 1e-5.
TEST(ImplicitSprings, SolveAnyStiffnessOfAFreeBody) {
  for (const Real stiffness : {1e6, 1e9, 1e12}) {
    Simulation simulation = make_simulation(make_block({stiffness, 0}, 0.1));
    const Motion start = motion_of(simulation);
    EXPECT_EQ(simulation.advance(20).unsolved_drifts, 0U) << stiffness;
    const Motion end = motion_of(simulation);
    EXPECT_NEAR(end.energy / start.energy, 1, 20 * kSpringTolerance) << stiffness;
    EXPECT_LT((end.momentum - start.momentum).norm(), 1e-12 * start.momentum.norm()) << stiffness;
    EXPECT_LT((end.angular_momentum - start.angular_momentum).norm(),
              1e-12 * start.angular_momentum.norm())
        << stiffness;
  }
}

/// A horizontal rope that is fixed at one end, with `count` particles at spacing 0.1 m.
Scene make_rope(int count, const SpringConstants& constants, Real step) {
  Scene scene = make_implicit_scene(step);
  scene.gravity = {0, 0, -9.81};
  ParticleShape shape = make_particles(make_lattice(count, 1, 1, 0.1), 0.1);
  shape.fixed = {0};
  scene.bodies = {make_body("rope", BodyKind::deformable, "rubber", shape, 0.02)};
  scene.bodies[0].springs = join_near(shape.positions, 0.11, constants);
  return scene;
}

// In one step the rope falls much farther than its springs can stretch, so that Newton's method
// does not converge. The motion stays bounded.
TEST(ImplicitSprings, ReportUnsolvedBodies) {
  Simulation simulation = make_simulation(make_rope(40, {1e12, 0}, 0.1));
  const Real start = simulation.diagnostics().gravitational_energy;
  const AdvanceReport report = simulation.advance(10);
  EXPECT_GT(report.unsolved_drifts, 0U);
  EXPECT_TRUE(report.events.empty());
  const Real released = start - simulation.diagnostics().gravitational_energy;
  EXPECT_GT(released, 0);
  EXPECT_LT(motion_of(simulation).energy, 2 * released);
}

}  // namespace
}  // namespace vat::test::implicit_springs_test
