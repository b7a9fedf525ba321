#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"
#include "tests/support/totals.h"

// Without gravity and vat nothing outside acts: what one body gains another loses, to round-off.

namespace vat::conservation_test {
namespace {

using namespace test;

constexpr BodyKind kKinds[] = {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid};

struct Drift {
  Real momentum = 0;          ///< over the sum of m |v|
  Real angular_momentum = 0;  ///< over the sum of m |v| times 1 m, the size of the scenes
  Real contact_energy = 0;    ///< greatest seen [J]
  Real density_error = 0;     ///< greatest seen
  Real exchanged = 0;         ///< greatest change of one body's momentum over the sum of m |v|
};

Drift collide(const Scene& scene, int ticks = 40) {
  Simulation simulation = make_simulation(scene);
  const Diagnostics start = simulation.diagnostics();
  const Totals before = totals_of(start);
  const Real motion = motion_of(simulation).momentum;
  Drift drift;
  for (int n = 0; n < ticks; ++n) {
    const AdvanceReport report = simulation.advance(10);
    EXPECT_TRUE(report.events.empty());
    const Diagnostics now = simulation.diagnostics();
    const Totals after = totals_of(now);
    const auto grow = [](Real& worst, Real value) { worst = std::max(worst, value); };
    grow(drift.momentum, (after.momentum - before.momentum).norm() / motion);
    grow(drift.angular_momentum,
         (after.angular_momentum - before.angular_momentum).norm() / motion);
    grow(drift.contact_energy, now.contact_energy);
    grow(drift.density_error, now.max_density_error);
    grow(drift.exchanged,
         (now.bodies[0].linear_momentum - start.bodies[0].linear_momentum).norm() / motion);
  }
  return drift;
}

/// Two blocks on a collision course, off centre so that they set each other turning.
Scene make_collision(BodyKind first, BodyKind second, IntegratorId integrator,
                     const char* second_material = "b", Real viscosity = 0) {
  Scene scene = make_two_material_scene(integrator, 1e-3, viscosity);
  scene.bodies = {
      make_block("first", first, "a", 4, {-0.15, 0, 0}, {1, 0, 0}),
      make_block("second", second, second_material, 4, {0.12, 0.07, 0.03}, {-0.7, 0.1, 0})};
  return scene;
}

/// Kicks along the line of centres at fixed positions, and drifts along the velocity at fixed
/// velocities, both keep x x v.
constexpr IntegratorId kKeepAngularMomentum[] = {IntegratorId::symplectic_euler,
                                                 IntegratorId::velocity_verlet};

// A sum of a thousand terms, a few hundred times over, of 1e-16 each.
constexpr Real kRoundOff = 1e-12;

TEST(Conservation, OfEveryPairOfKinds) {
  for (const IntegratorId integrator : kIntegrators) {
    const bool keeps_angular_momentum = std::ranges::count(kKeepAngularMomentum, integrator) > 0;
    for (const BodyKind first : kKinds) {
      for (const BodyKind second : kKinds) {
        SCOPED_TRACE(std::string(to_string(integrator)) + ": " + to_string(first) + " and " +
                     to_string(second));
        const Drift drift = collide(make_collision(first, second, integrator));
        EXPECT_GT(drift.contact_energy, 0.01);
        EXPECT_GT(drift.exchanged, 0.1);
        EXPECT_LT(drift.momentum, kRoundOff);
        if (keeps_angular_momentum) {
          EXPECT_LT(drift.angular_momentum, kRoundOff);
        }
      }
    }
  }
}

struct MovingMass {
  Real mass;
  Vec3 velocity;
};
/// Free particles, and rigid bodies as a whole.
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

// With x' = x + dt v and v' = v + dt a, x' x v' - x x v = dt x x a + dt v x v': the first terms
// cancel in the sum over all, the second are what explicit Euler adds to the angular momentum.
TEST(Conservation, ExplicitEulerGainsAngularMomentumAsTheorySays) {
  for (const BodyKind first : kKinds) {
    for (const BodyKind second : kKinds) {
      SCOPED_TRACE(std::string(to_string(first)) + " and " + to_string(second));
      Simulation simulation =
          make_simulation(make_collision(first, second, IntegratorId::explicit_euler));
      const Real motion = motion_of(simulation).momentum;
      Real greatest_gain = 0;
      for (int step = 0; step < 150; ++step) {
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
        EXPECT_LT((momentum - momentum_before - gain).norm() / motion, kRoundOff);
      }
      EXPECT_GT(greatest_gain, 1e4 * kRoundOff);
    }
  }
}

/// Drift in 0.1 s of the angular momentum of a block of stretched springs that spins in free
/// flight: smooth forces, so that a method shows its order.
Real drift_of_spinning_block(IntegratorId integrator, Real step) {
  Scene scene = make_two_material_scene(integrator, step);
  BodyDescription body =
      make_block("block", BodyKind::deformable, "a", 3, Vec3::Zero(), Vec3::Zero());
  const std::vector<Vec3>& points = std::get<ParticleShape>(body.shape).positions;
  for (SpringDescription& spring : body.springs) {
    spring.rest_length = 0.9 * (points[spring.a] - points[spring.b]).norm();
  }
  body.angular_velocity = {10, -20, 30};
  scene.bodies = {body};
  Simulation simulation = make_simulation(scene);
  const Vec3 before = simulation.diagnostics().bodies[0].angular_momentum;
  EXPECT_GT(simulation.diagnostics().elastic_energy, 1);
  advance_to(simulation, 0.1);
  return (simulation.diagnostics().bodies[0].angular_momentum - before).norm() / before.norm();
}

// Of any quadratic quantity Q with rate zero Heun gains dt^2 Q(f_2 - f_1) / 4 in a step, f_1 and
// f_2 the rates of its stages: one order better than the method itself.
TEST(Conservation, AngularMomentumDriftsWithTheOrderOfTheMethod) {
  constexpr Real kStep = 2e-4;
  for (const auto& [integrator, order] :
       {std::pair(IntegratorId::explicit_euler, 1), std::pair(IntegratorId::heun, 3),
        std::pair(IntegratorId::runge_kutta_4, 4)}) {
    const Real coarse = drift_of_spinning_block(integrator, kStep);
    const Real fine = drift_of_spinning_block(integrator, kStep / 2);
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.2) << to_string(integrator);
  }
  for (const IntegratorId integrator : kKeepAngularMomentum) {
    EXPECT_LT(drift_of_spinning_block(integrator, kStep), kRoundOff);
  }
}

TEST(Conservation, OfOneLiquidMeetingItself) {
  for (const IntegratorId integrator : kKeepAngularMomentum) {
    const Drift drift =
        collide(make_collision(BodyKind::liquid, BodyKind::liquid, integrator, "a"));
    EXPECT_EQ(drift.contact_energy, 0);
    EXPECT_GT(drift.density_error, 0.01);  // pressure did it
    EXPECT_GT(drift.exchanged, 0.1);
    EXPECT_LT(drift.momentum, kRoundOff);
    EXPECT_LT(drift.angular_momentum, kRoundOff);
  }
}

// Viscosity acts along the velocities, not the line of centres: it keeps momentum alone.
TEST(Conservation, OfViscousLiquidIsOfMomentum) {
  for (const IntegratorId integrator : kIntegrators) {
    const Drift drift =
        collide(make_collision(BodyKind::liquid, BodyKind::liquid, integrator, "a", 2));
    EXPECT_GT(drift.exchanged, 0.1);
    EXPECT_LT(drift.momentum, kRoundOff);
  }
}

TEST(Conservation, OfABodyMeetingItself) {
  Scene scene = make_two_material_scene(IntegratorId::velocity_verlet, 1e-3);
  BodyDescription body =
      make_block("body", BodyKind::deformable, "a", 4, Vec3::Zero(), Vec3::Zero());
  auto& shape = std::get<ParticleShape>(body.shape);
  const std::vector<Vec3> half = shape.positions;
  const std::vector<SpringDescription> springs = body.springs;
  const auto count = static_cast<Index>(half.size());
  shape.velocities.assign(count, {1, 0, 0});
  for (const Vec3& p : half) {
    shape.positions.push_back(p + Vec3(0.27, 0.07, 0.03));
    shape.velocities.push_back({-1, 0.1, 0});
    shape.masses.push_back(0.125);
  }
  for (SpringDescription spring : springs) {
    spring.a += count;
    spring.b += count;
    body.springs.push_back(spring);
  }
  scene.bodies = {body};
  const Drift drift = collide(scene);
  EXPECT_GT(drift.contact_energy, 0.01);
  EXPECT_LT(drift.momentum, kRoundOff);
  EXPECT_LT(drift.angular_momentum, kRoundOff);
}

TEST(Conservation, OfThreeKindsAtOnce) {
  for (const IntegratorId integrator : kKeepAngularMomentum) {
    Scene scene = make_collision(BodyKind::liquid, BodyKind::deformable, integrator);
    scene.bodies.push_back(
        make_block("third", BodyKind::rigid, "b", 3, {0, -0.2, 0.05}, {0, 1, 0}));
    const Drift drift = collide(scene, 100);
    EXPECT_GT(drift.contact_energy, 0.01);
    EXPECT_LT(drift.momentum, kRoundOff);
    EXPECT_LT(drift.angular_momentum, kRoundOff);
  }
}

/// Overlapping blocks of all kinds with particles moved and pushed about at random.
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
}

TEST(Conservation, ViscousForcesCancelAndBrake) {
  const ForceSums with = sum_forces(make_heap(5));
  const ForceSums without = sum_forces(make_heap(0));
  EXPECT_LT(with.force.norm(), 1e-15 * with.size);
  EXPECT_LT(with.power, without.power - 1);
}

// The same collision seen from a moving frame.
TEST(Conservation, MotionIsTheSameFromAMovingFrame) {
  const Vec3 wind(3, -2, 1);
  for (const BodyKind first : kKinds) {
    for (const BodyKind second : kKinds) {
      Scene scene = make_collision(first, second, IntegratorId::velocity_verlet);
      Scene moving = scene;
      for (BodyDescription& body : moving.bodies) body.velocity += wind;
      Simulation a = make_simulation(scene);
      Simulation b = make_simulation(moving);
      advance_to(a, 0.15);
      advance_to(b, 0.15);
      for (std::size_t body = 0; body < 2; ++body) {
        for (std::size_t i = 0; i < 64; ++i) {
          const Vec3 seen = position_of(b, body, i) - 0.15 * wind;
          EXPECT_LT((seen - position_of(a, body, i)).norm(), 1e-11);
        }
      }
    }
  }
}

}  // namespace
}  // namespace vat::conservation_test
