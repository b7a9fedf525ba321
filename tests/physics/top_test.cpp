#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.h"

// Free rotation of bodies with equal and with very different moments; RIG-1 to RIG-3 have theory.

namespace vat::top_test {
namespace {

using namespace test;

/// Six points of 0.5 kg on the axes; their own radius of 1e-6 adds 1e-12 to the moments.
Scene make_top(Real step, const Vec3& angular_velocity, const Vec3& inertia) {
  // I_x = y^2 + z^2 with the squares of the three arms, as the two points on an axis weigh 1.
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
        Simulation simulation = make_simulation(make_top(step, rate, inertia));
        advance_to(simulation, 10);
        const Quat& found = simulation.bodies()[0].pose->orientation;
        EXPECT_LT(found.angularDistance(symmetric_top_at(10, rate, axis, 1, other)), 4e-10)
            << "axis " << axis << ", moment " << other << ", step " << step;
      }
    }
  }
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

}  // namespace
}  // namespace vat::top_test
