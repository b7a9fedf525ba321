#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.h"

// Free rotation against Jacobi's solution (the cases RIG-1 to RIG-3).

namespace vat::top_test {
namespace {

using namespace test;

/// Six points of 0.5 kg on the axes give I = diag(2, 3, 4); their own radius of 1e-6 adds 1e-12.
Scene make_top(IntegratorId integrator, Real step, const Vec3& angular_velocity,
               const Vec3& inertia = {2, 3, 4}) {
  // I_x = y^2 + z^2 with the squares of the three arms, as the two points on an axis weigh 1.
  const Vec3 square = Vec3::Constant(inertia.sum() / 2) - inertia;
  std::vector<Vec3> points;
  for (int axis = 0; axis < 3; ++axis) {
    points.push_back(std::sqrt(square[axis]) * Vec3::Unit(axis));
    points.push_back(-points.back());
  }
  Scene scene = make_scene(integrator, step);
  scene.materials = {make_material("steel")};
  scene.bodies = {make_body("top", BodyKind::rigid, "steel", make_particles(points, 0.5), 1e-6)};
  scene.bodies[0].angular_velocity = angular_velocity;
  return scene;
}

RigidPose pose_of(const Simulation& simulation) {
  return *simulation.bodies()[0].pose;
}

Vec3 body_rate(const Simulation& simulation) {
  const RigidPose pose = pose_of(simulation);
  return pose.orientation.conjugate() * pose.angular_velocity;
}

/// Distance of quaternions; q and -q are one orientation.
Real distance(const Quat& a, const Quat& b) {
  return std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

const Vec3 kRate(1, 0, 1);

struct Sample {
  Real time;
  Vec3 rate;
  Quat orientation;
};
const Sample kSamples[] = {
    {1,
     {0.8459564458295569, 0.6157463674375719, 0.9261863495648638},
     {0.7662704546614366, 0.4103489939126134, 0.14403585480980324, 0.47296613624769196}},
    {5,
     {-0.7099320726663687, 0.8132211279429753, 0.8671803583454731},
     {-0.8796148551448179, -0.28046713987802746, -0.3739208503751793, 0.08831244369794526}},
    {10,
     {0.14938913127780906, -1.1417430460811875, 0.7149535343446938},
     {0.8831781538207485, -0.4241111687539092, 0.19388154793694798, 0.05035881771388714}},
    {50,
     {0.7243138165366062, -0.7961318945787611, 0.8731066672594547},
     {0.9053845854706628, -0.3681928629127852, 0.12174152137733844, -0.1728923655484361}}};

TEST(Top, AsymmetricTopFollowsJacobi) {
  // Order four: the error at t = 10 of an independent implementation, 5.2e-9 with this step, grows
  // no faster than linearly from one sample to the next.
  for (const IntegratorId integrator :
       {IntegratorId::symplectic_euler, IntegratorId::velocity_verlet,
        IntegratorId::runge_kutta_4}) {
    Simulation simulation = make_simulation(make_top(integrator, 0.01, kRate));
    for (const Sample& sample : kSamples) {
      advance_to(simulation, sample.time);
      const Real bound = 1e-8 * std::max<Real>(1, sample.time / 10);
      EXPECT_LT(distance(pose_of(simulation).orientation, sample.orientation), bound);
      EXPECT_LT((body_rate(simulation) - sample.rate).norm(), bound);
    }
  }
}

Real attitude_error(IntegratorId integrator, Real step) {
  Simulation simulation = make_simulation(make_top(integrator, step, kRate));
  advance_to(simulation, 10);
  return distance(pose_of(simulation).orientation, kSamples[2].orientation);
}

// Without torques the symplectic methods turn bodies by the fourth-order rotation alone.
TEST(Top, ObservedOrderIsThatOfEachMethod) {
  const auto order_of = [](IntegratorId integrator, Real step) {
    return std::log2(attitude_error(integrator, step) / attitude_error(integrator, step / 2));
  };
  EXPECT_NEAR(order_of(IntegratorId::explicit_euler, 1e-3), 1, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::symplectic_euler, 0.04), 4, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::velocity_verlet, 0.04), 4, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::heun, 0.02), 2, 0.2);
  EXPECT_NEAR(order_of(IntegratorId::runge_kutta_4, 0.04), 4, 0.2);
}

TEST(Top, ErrorsAreThoseOfAnIndependentImplementation) {
  EXPECT_LT(attitude_error(IntegratorId::explicit_euler, 0.01), 0.080 * 1.05);
  EXPECT_LT(attitude_error(IntegratorId::heun, 0.04), 9.7e-3 * 1.05);
  EXPECT_LT(attitude_error(IntegratorId::heun, 0.01), 6.1e-4 * 1.05);
  EXPECT_LT(attitude_error(IntegratorId::velocity_verlet, 0.04), 1.3e-6 * 1.05);
  EXPECT_LT(attitude_error(IntegratorId::velocity_verlet, 0.01), 5.2e-9 * 1.05);
}

Real energy_drift(IntegratorId integrator, Real step) {
  Simulation simulation = make_simulation(make_top(integrator, step, kRate));
  const Diagnostics start = simulation.diagnostics();
  EXPECT_NEAR(start.kinetic_energy, 3, 1e-11);
  EXPECT_NEAR(start.bodies[0].angular_momentum.squaredNorm(), 20, 1e-10);
  advance_to(simulation, 2000);
  const Diagnostics end = simulation.diagnostics();
  EXPECT_EQ(end.bodies[0].angular_momentum, start.bodies[0].angular_momentum);
  return std::abs(end.kinetic_energy / start.kinetic_energy - 1);
}

// No torque: L is not touched, so it stays to the bit. The energy errs with the orientation, to the
// fourth order of the step at least, over a fixed time of 156 periods.
TEST(Top, AngularMomentumStaysToTheBitAndEnergyClose) {
  for (const IntegratorId integrator :
       {IntegratorId::symplectic_euler, IntegratorId::velocity_verlet}) {
    const Real coarse = energy_drift(integrator, 0.04);
    const Real fine = energy_drift(integrator, 0.02);
    EXPECT_LT(fine, 1e5 * std::pow(std::sqrt(20.0) / 2 * 0.02 / 2, 5) / 120);
    EXPECT_GT(std::log2(coarse / fine), 4 - 0.2);
  }
}

// The unstable axis: a code without the gyroscopic term never flips.
TEST(Top, IntermediateAxisFlipsWhenItShould) {
  constexpr Real kStep = 0.01;
  Simulation simulation =
      make_simulation(make_top(IntegratorId::velocity_verlet, kStep, {0.01, 2, 0}));
  std::vector<Real> zeros;
  Real before = 2;
  while (simulation.time() < 47) {
    simulation.advance(1);
    const Real rate = body_rate(simulation).y();
    if (before * rate < 0) {
      zeros.push_back(simulation.time() - kStep * rate / (rate - before));
    }
    before = rate;
  }
  ASSERT_EQ(zeros.size(), 3U);
  // Between samples the rate is a line to within kStep^2: 1e-4 of a second.
  EXPECT_NEAR(zeros[0], 9.249981322788452, 1e-4);
  EXPECT_NEAR(zeros[1], 27.74994396846497, 1e-4);
  EXPECT_NEAR(zeros[2], 46.24990661407096, 1e-4);
}

/// Of a body with moments `equal` about two axes and `other` about the third, from its first rate:
/// the rate turns in the body at (other - equal) / equal times its part along the third axis, and
/// the body about L at |L| / equal.
Quat symmetric_top_at(Real time, const Vec3& rate, int axis, Real equal, Real other) {
  const Vec3 third = Vec3::Unit(axis);
  const Real excess = (other - equal) / equal * rate[axis];
  const Vec3 momentum = equal * rate + (other - equal) * rate[axis] * third;
  return Quat(Eigen::AngleAxis<Real>(momentum.norm() / equal * time, momentum.normalized())) *
         Quat(Eigen::AngleAxis<Real>(-excess * time, third));
}

// Turns about L and about the third axis are all that there is: no step is too long. The points'
// own radius changes the moments by 1e-12, and the phases by as much of some 50 rad.
TEST(Top, SymmetricTopIsExactWithAnyStep) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const Real other : {0.3, 1.9}) {  // long and flat bodies
      Vec3 inertia = Vec3::Ones();
      inertia[axis] = other;
      Vec3 rate = Vec3::Constant(2);
      rate[axis] = 3;
      rate[(axis + 1) % 3] = -1;
      for (const Real step : {1e-3, 0.02, 0.1}) {
        Simulation simulation =
            make_simulation(make_top(IntegratorId::velocity_verlet, step, rate, inertia));
        advance_to(simulation, 10);
        EXPECT_LT(
            distance(pose_of(simulation).orientation, symmetric_top_at(10, rate, axis, 1, other)),
            2e-10)
            << "axis " << axis << ", moment " << other << ", step " << step;
      }
    }
  }
}

// I = (1, 1, 2).
TEST(Top, SymmetricTopPrecesses) {
  Simulation simulation =
      make_simulation(make_top(IntegratorId::velocity_verlet, 0.1, {1, 0, 2}, {1, 1, 2}));
  const Vec3 momentum(1, 0, 4);
  for (const Real time : {1.0, 10.0}) {
    advance_to(simulation, time);
    EXPECT_LT((body_rate(simulation) - Vec3(std::cos(2 * time), std::sin(2 * time), 2)).norm(),
              1e-10);
    const Vec3 axis = pose_of(simulation).orientation * Vec3::UnitZ();
    EXPECT_NEAR(std::acos(axis.dot(momentum.normalized())) * 180 / std::numbers::pi,
                14.036243467926479, 1e-10);
  }
  EXPECT_LT(
      distance(pose_of(simulation).orientation, Quat(-0.3550286240495591, -0.19964091026648448,
                                                     -0.12943934577506308, -0.9040705939354351)),
      1e-10);
}

/// Eleven particles of 1 mm along x, 0.1 m from one to the next, and one beside the middle. With no
/// arm that one is left out.
Scene make_thin_rod(Real arm, const Vec3& angular_velocity) {
  std::vector<Vec3> points = make_lattice(11, 1, 1, 0.1);
  if (arm > 0) points.push_back({0, arm, 0});
  Scene scene = make_scene(IntegratorId::velocity_verlet, 2e-3);
  scene.materials = {make_material("steel")};
  scene.bodies = {make_body("rod", BodyKind::rigid, "steel", make_particles(points, 0.1), 1e-3)};
  scene.bodies[0].angular_velocity = angular_velocity;
  return scene;
}

// The moment about the rod is 4e-6 of the others: about it the least momentum turns it fast, and a
// method that lets the energy drift speeds that up without end.
TEST(Top, ThinRodKeepsItsEnergy) {
  for (const Real arm : {0.0, 2e-3, 0.02}) {
    for (const Vec3& rate : {Vec3(0, 10, 0), Vec3(0, 6, 8), Vec3(20, 10, 0)}) {
      Simulation simulation = make_simulation(make_thin_rod(arm, rate));
      const Diagnostics start = simulation.diagnostics();
      for (int second = 1; second <= 20; ++second) {
        advance_to(simulation, second);
        const Diagnostics now = simulation.diagnostics();
        EXPECT_NEAR(now.kinetic_energy / start.kinetic_energy, 1, 1e-9)
            << "arm " << arm << ", rate " << rate.transpose() << ", time " << second;
        // About the origin, from which rounding sets the centre of mass 1e-17 m apart.
        const Vec3 momentum = start.bodies[0].angular_momentum;
        EXPECT_LT((now.bodies[0].angular_momentum - momentum).norm(), 1e-16 * momentum.norm());
      }
    }
  }
}

// Turning the body's frame at the start changes only the frame: the particles go the same way.
TEST(Top, MotionDoesNotDependOnTheBodyAxes) {
  Scene scene = make_top(IntegratorId::velocity_verlet, 0.01, kRate);
  Scene turned = scene;
  const Quat turn(Eigen::AngleAxis<Real>(0.7, Vec3(1, 2, -3).normalized()));
  turned.bodies[0].orientation = turn;
  for (Vec3& p : std::get<ParticleShape>(turned.bodies[0].shape).positions) {
    p = turn.conjugate() * p;
  }
  Simulation a = make_simulation(scene);
  Simulation b = make_simulation(turned);
  advance_to(a, 5);
  advance_to(b, 5);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LT((position_of(a, 0, i) - position_of(b, 0, i)).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace vat::top_test
