#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/scenes.h"

// Free rotation of bodies with equal and very different moments. RIG-1 to RIG-3 compare it with
// theory.

namespace vat::top_test {
namespace {

using namespace test;

/// Six points of 0.5 kg on the axes. Their radius of 1e-6 adds 1e-12 to the moments.
Scene make_top(Real step, const Vec3& angular_velocity, const Vec3& inertia) {
  // I_x = y^2 + z^2 with the squares of the three arms, since the two points on an axis have a mass
  // of 1.
  const Vec3 square = Vec3::Constant(inertia.sum() / 2) - inertia;
  std::vector<Vec3> points;
  for (int axis = 0; axis < 3; ++axis) {
    points.push_back(std::sqrt(square[axis]) * Vec3::Unit(axis));
    points.push_back(-points.back());
  }
  Scene scene = make_scene(IntegratorId::velocity_verlet, step);
  scene.materials = {make_material("steel")};
  scene.bodies = {make_body("top", BodyKind::rigid, "steel", make_particles(points, 0.5), 1e-6)};
  scene.bodies[0].angular_velocity = angular_velocity;
  return scene;
}

/// Returns the orientation of a body with moments `equal` about two axes and `other` about the
/// third. In the body, the rate vector rotates at (other - equal) / equal times its component along
/// the third axis. The body rotates about L at |L| / equal.
Quat symmetric_top_at(Real time, const Vec3& rate, int axis, Real equal, Real other) {
  const Vec3 third = Vec3::Unit(axis);
  const Real excess = (other - equal) / equal * rate[axis];
  const Vec3 momentum = equal * rate + (other - equal) * rate[axis] * third;
  return Quat(Eigen::AngleAxis<Real>(momentum.norm() / equal * time, momentum.normalized())) *
         Quat(Eigen::AngleAxis<Real>(-excess * time, third));
}

// The motion consists of rotations about L and about the third axis, so every step is exact. The
// points' radius changes the moments by 1e-12, and the phases by the same fraction of about 50 rad.
TEST(Top, SymmetricTopIsExactWithAnyStep) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const Real other : {0.3, 1.9}) {  // long and flat bodies
      Vec3 inertia = Vec3::Ones();
      inertia[axis] = other;
      Vec3 rate = Vec3::Constant(2);
      rate[axis] = 3;
      rate[(axis + 1) % 3] = -1;
      for (const Real step : {1e-3, 0.02, 0.1}) {
        Simulation simulation = make_simulation(make_top(step, rate, inertia));
        advance_to(simulation, 10);
        const Quat& found = simulation.bodies()[0].pose->orientation;
        EXPECT_LT(found.angularDistance(symmetric_top_at(10, rate, axis, 1, other)), 4e-10)
            << "axis " << axis << ", moment " << other << ", step " << step;
      }
    }
  }
}

/// Eleven particles of 1 mm along x at intervals of 0.1 m, and one next to the middle at a distance
/// of `arm`. With arm 0 the last is omitted.
Scene make_thin_rod(Real arm, const Vec3& angular_velocity) {
  std::vector<Vec3> points = make_lattice(11, 1, 1, 0.1);
  if (arm > 0) points.push_back({0, arm, 0});
  Scene scene = make_scene(IntegratorId::velocity_verlet, 2e-3);
  scene.materials = {make_material("steel")};
  scene.bodies = {make_body("rod", BodyKind::rigid, "steel", make_particles(points, 0.1), 1e-3)};
  scene.bodies[0].angular_velocity = angular_velocity;
  return scene;
}

// The moment about the rod is 4e-6 of the others. A small momentum about it causes a fast rotation.
// If a method lets the energy drift, that rotation accelerates without limit.
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
        // About the origin. Rounding moves the centre of mass 1e-17 m away from it.
        const Vec3 momentum = start.bodies[0].angular_momentum;
        EXPECT_LT((now.bodies[0].angular_momentum - momentum).norm(), 1e-16 * momentum.norm());
      }
    }
  }
}

}  // namespace
}  // namespace vat::top_test
