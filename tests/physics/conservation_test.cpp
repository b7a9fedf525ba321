#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/momentum_watch.h"

// Without gravity and vat no external force acts: total momentum is constant to round-off.

namespace vat::conservation_test {
namespace {

using namespace test;

constexpr BodyKind kKinds[] = {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid};

struct Case {
  InterfaceConstants law{500, 1};
  IntegratorId integrator = IntegratorId::velocity_verlet;
  StepControl control = StepControl::fixed;
  Real step = 1e-3;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const IntegratorId integrator : kIntegrators) all.push_back({.integrator = integrator});
  for (const Real damping : {0.0, 40.0, 100.0}) {  // the last is solved implicitly
    all.push_back({.law = {5000, damping, 0.5}});
  }
  for (const StepControl control : {StepControl::adaptive, StepControl::local}) {
    all.push_back({.law = {5000, 4, 0}, .control = control, .step = 2e-3});
    all.push_back({.law = {5000, 40, 0.5}, .control = control});
  }
  const InterfaceConstants projection{
      .friction = 0.4, .law = InterfaceLaw::projection, .restitution = 0.3};
  for (const IntegratorId integrator :
       {IntegratorId::velocity_verlet, IntegratorId::symplectic_euler}) {
    all.push_back({.law = projection, .integrator = integrator, .step = 4e-3});
  }
  return all;
}

/// Forces along the line of centres at fixed positions, and drifts along the velocity at fixed
/// velocities, conserve x x v. Friction between free particles exerts a couple.
bool keeps_angular_momentum(const Case& c, BodyKind first, BodyKind second) {
  const bool can_spin = first == BodyKind::rigid || second == BodyKind::rigid;
  return (c.integrator == IntegratorId::velocity_verlet ||
          c.integrator == IntegratorId::symplectic_euler) &&
         (c.law.friction == 0 || can_spin);
}

TEST(Conservation, OfEveryPairOfKindsWithEveryLawAndMethod) {
  for (const Case& c : cases()) {
    for (const BodyKind first : kKinds) {
      for (const BodyKind second : kKinds) {
        SCOPED_TRACE(testing::Message()
                     << to_string(c.integrator) << ' ' << to_string(c.control) << ' '
                     << to_string(c.law.law) << " damping " << c.law.damping << " friction "
                     << c.law.friction << ": " << to_string(first) << " and " << to_string(second));
        Scene scene = make_collision(first, second, c.integrator, c.step);
        scene.default_interface = c.law;
        scene.numerics.control = c.control;
        Simulation simulation = make_simulation(scene);
        const MomentumWatch watch(simulation);
        const Vec3 start = simulation.diagnostics().bodies[0].linear_momentum;
        advance_to(simulation, 0.2);
        const Vec3 end = simulation.diagnostics().bodies[0].linear_momentum;
        EXPECT_GT((end - start).norm(), 0.1 * start.norm());
        watch.expect_momentum();
        if (keeps_angular_momentum(c, first, second)) watch.expect_angular_momentum(1e-11);
      }
    }
  }
}

struct MovingMass {
  Real mass;
  Vec3 velocity;
};
/// Returns the free particles, and rigid bodies as a whole.
std::vector<MovingMass> moving_masses(const Simulation& simulation) {
  std::vector<MovingMass> result;
  for (const BodyView& body : simulation.bodies()) {
    if (body.pose) {
      const Real mass = std::accumulate(body.masses.begin(), body.masses.end(), Real{0});
      result.push_back({mass, body.pose->velocity});
      continue;
    }
    for (std::size_t i = 0; i < body.masses.size(); ++i) {
      result.push_back({body.masses[i], body.velocities[i]});
    }
  }
  return result;
}

// With x' = x + dt v and v' = v + dt a, x' x v' - x x v = dt x x a + dt v x v'. The first terms
// cancel in the sum over all bodies. The second terms are the error of explicit Euler.
TEST(Conservation, ExplicitEulerGainsAngularMomentumAsPredicted) {
  for (const BodyKind kind : kKinds) {
    SCOPED_TRACE(to_string(kind));
    Simulation simulation =
        make_simulation(make_collision(kind, BodyKind::rigid, IntegratorId::explicit_euler, 1e-3));
    const Real motion = motion_of(simulation).momentum;
    Real greatest_gain = 0;
    for (int step = 0; step < 100; ++step) {
      const std::vector<MovingMass> before = moving_masses(simulation);
      const Vec3 momentum_before = totals_of(simulation.diagnostics()).angular_momentum;
      simulation.advance(1);
      const std::vector<MovingMass> after = moving_masses(simulation);
      Vec3 gain = Vec3::Zero();
      for (std::size_t i = 0; i < before.size(); ++i) {
        gain +=
            simulation.step_size() * before[i].mass * before[i].velocity.cross(after[i].velocity);
      }
      greatest_gain = std::max(greatest_gain, gain.norm() / motion);
      const Vec3 momentum = totals_of(simulation.diagnostics()).angular_momentum;
      EXPECT_LT((momentum - momentum_before - gain).norm() / motion, 1e-12);
    }
    EXPECT_GT(greatest_gain, 1e-8);
  }
}

/// Overlapping blocks of all kinds with random displacements, masses and velocities.
Scene make_heap(Real viscosity) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 1e-3, viscosity);
  std::mt19937_64 random(21);
  std::uniform_real_distribution<Real> unit(-1, 1);
  int n = 0;
  for (const BodyKind kind : kKinds) {
    for (const char* material : {"a", "b"}) {
      BodyDescription body = make_block("body" + std::to_string(n), kind, material, 4,
                                        0.06 * n * Vec3(1, 0.4, 0.2), Vec3::Zero());
      auto& shape = std::get<ParticleShape>(body.shape);
      for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        shape.positions[i] += 0.01 * Vec3(unit(random), unit(random), unit(random));
        shape.masses[i] *= 1.5 + unit(random);
        if (kind != BodyKind::rigid) {
          shape.velocities.push_back({unit(random), unit(random), unit(random)});
        }
      }
      scene.bodies.push_back(body);
      ++n;
    }
  }
  return scene;
}

struct ForceSums {
  Vec3 force = Vec3::Zero();
  Vec3 torque = Vec3::Zero();
  Real size = 0;
  Real power = 0;
};
ForceSums sum_forces(const Scene& scene) {
  ForceProbe probe(scene);
  ForceSums sums;
  const State& state = probe.state();
  for (Index i = 0; i < probe.model().particle_count; ++i) {
    const Vec3& force = state.forces.particle[i];
    sums.force += force;
    sums.torque += state.now.position[i].cross(force);
    sums.size += force.norm();
    sums.power += force.dot(state.now.velocity[i]);
  }
  return sums;
}

TEST(Conservation, InternalForcesAndTorquesCancel) {
  const ForceSums sums = sum_forces(make_heap(0));
  EXPECT_GT(sums.size, 1000);
  EXPECT_LT(sums.force.norm(), 1e-15 * sums.size);
  EXPECT_LT(sums.torque.norm(), 1e-15 * sums.size);
  const ForceSums viscous = sum_forces(make_heap(5));
  EXPECT_LT(viscous.force.norm(), 1e-15 * viscous.size);
  EXPECT_LT(viscous.power, sums.power - 1) << "viscosity dissipates";
}

}  // namespace
}  // namespace vat::conservation_test
