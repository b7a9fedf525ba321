// Forces of no-slip walls on a liquid: closed forms compared with quadrature, and the force itself.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/kernels/half_space.h"
#include "core/kernels/mueller_kernels.h"
#include "tests/core/kernels/quadrature.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::no_slip_test {
namespace {

/// Returns the integral of w(r) over the part of a sphere of radius r (a circle in two dimensions)
/// beyond a distance d along the normal.
Real beyond(int dimensions, Real d, Real h, const std::function<Real(Real)>& w) {
  return integrate(d, h, [&](Real r) {
    const Real measure =
        dimensions == 3 ? 2 * std::numbers::pi * r * r * (1 - d / r) : 2 * r * std::acos(d / r);
    return measure * w(r);
  });
}

/// Returns the same integral of s w(r). s is the distance along the normal.
Real moment_beyond(int dimensions, Real d, Real h, const std::function<Real(Real)>& w) {
  return integrate(d, h, [&](Real r) {
    const Real measure =
        dimensions == 3 ? std::numbers::pi * r * (r * r - d * d) : 2 * r * std::sqrt(r * r - d * d);
    return measure * w(r);
  });
}

TEST(HalfSpace, FillingIsTheIntegralOfTheDensityKernel) {
  for (const int dimensions : {2, 3}) {
    for (const Real h : {0.04, 1.0, 3.5}) {
      const HalfSpace space(h, dimensions);
      const Poly6 kernel(h, dimensions);
      for (const Real q : {0.0, 0.01, 0.2, 0.5, 0.9, 0.999}) {
        const Real expected =
            beyond(dimensions, q * h, h, [&](Real r) { return kernel.value(r * r); });
        EXPECT_NEAR(space.filling(q * h), expected, 1e-10) << dimensions << ' ' << q;
      }
      EXPECT_NEAR(space.filling(0), 0.5, 1e-15);
      EXPECT_EQ(space.filling(-h), space.filling(0));
      EXPECT_EQ(space.filling(h), 0);
      EXPECT_EQ(space.filling(2 * h), 0);
    }
  }
}

TEST(HalfSpace, DragIsTheMomentOfTheLaplacian) {
  for (const int dimensions : {2, 3}) {
    for (const Real h : {0.04, 1.0, 3.5}) {
      const HalfSpace space(h, dimensions);
      const ViscosityKernel kernel(h, dimensions);
      for (const Real q : {HalfSpace::kMinDistance, 0.2, 0.5, 0.9, 0.999}) {
        const Real d = q * h;
        const Real expected =
            moment_beyond(dimensions, d, h, [&](Real r) { return kernel.laplacian(r); }) / d;
        EXPECT_NEAR(space.drag(d), expected, 1e-10 / (h * h)) << dimensions << ' ' << q;
      }
      EXPECT_EQ(space.drag(h), 0);
      EXPECT_EQ(space.drag(3 * h), 0);
    }
  }
}

// The integral is finite at the wall: 9/(4h) and 20/(3 pi h). Only the factor 1/d is limited.
TEST(HalfSpace, DragIsBoundedAtTheWall) {
  const Real least = HalfSpace::kMinDistance;
  EXPECT_NEAR(HalfSpace(2, 3).drag(0), 9.0 / 4 / 4 / least, 1e-12);
  EXPECT_NEAR(HalfSpace(2, 2).drag(0), 20 / (3 * std::numbers::pi) / 4 / least, 1e-12);
  EXPECT_EQ(HalfSpace(2, 3).drag(-1), HalfSpace(2, 3).drag(0));
  for (const int dimensions : {2, 3}) {
    Real before = HalfSpace(1, dimensions).drag(0);
    for (int n = 1; n <= 100; ++n) {
      const Real drag = HalfSpace(1, dimensions).drag(n / 100.0);
      EXPECT_LT(drag, before);
      before = drag;
    }
  }
}

constexpr Real kSupport = 0.1;
constexpr Real kViscosity = 3;
constexpr Real kMass = 0.2;

/// One liquid particle at `position` in a vat of 1 m. The wall `wall` is no-slip.
Scene make_wall_scene(int wall, const Vec3& position, const Vec3& velocity) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-4,
                           {make_liquid("water", 1000, {0, kViscosity, kSupport})});
  scene.bodies = {
      make_body("drop", BodyKind::liquid, "water", make_particles({position}, kMass), 0.001)};
  scene.bodies[0].velocity = velocity;
  scene.vat = Vat{Vec3::Zero(), Vec3::Ones(), true, {}, {}};
  scene.vat->walls[static_cast<std::size_t>(wall)].no_slip = true;
  return scene;
}

TEST(NoSlip, DragsAlongEachWallOnly) {
  constexpr Real kDistance = 0.03;
  const HalfSpace space(kSupport, 3);
  const Real density = kMass * Poly6(kSupport).value(0) + 1000 * space.filling(kDistance);
  const Real drag = kViscosity * kMass / density * space.drag(kDistance);
  for (int wall = 0; wall < 6; ++wall) {
    const int axis = wall / 2;
    Vec3 position = Vec3::Constant(0.5);
    position[axis] = wall % 2 == 0 ? kDistance : 1 - kDistance;
    Scene scene = make_wall_scene(wall, position, {1, -2, 3});
    Vec3 slip(1, -2, 3);
    slip[axis] = 0;
    EXPECT_LT((ForceProbe(scene).force(0) + drag * slip).norm(), 1e-12 * drag) << wall;

    Vec3& wall_velocity = scene.vat->walls[static_cast<std::size_t>(wall)].velocity;
    wall_velocity = {0.5, 0.25, -1};
    wall_velocity[axis] = 0;
    EXPECT_LT((ForceProbe(scene).force(0) + drag * (slip - wall_velocity)).norm(), 1e-12 * drag);

    scene.vat->walls[static_cast<std::size_t>(wall)].no_slip = false;
    EXPECT_EQ(ForceProbe(scene).force(0), Vec3::Zero());
  }
}

TEST(NoSlip, EndsAtTheSupport) {
  EXPECT_EQ(ForceProbe(make_wall_scene(4, {0.5, 0.5, kSupport}, {1, 0, 0})).force(0), Vec3::Zero());
}

TEST(NoSlip, MovesWithTheVat) {
  Scene scene = make_wall_scene(4, {0.5, 0.5, 0.05}, {0, 0, 0});
  scene.vat->motion = SlideMotion{Vec3::UnitY(), 0.2, 4};
  ForceProbe probe(scene);
  EXPECT_EQ(probe.force(0), Vec3::Zero());
  probe.evaluate(1);  // the vat moves at 0.1 pi/2 along y
  EXPECT_EQ(probe.force(0).x(), 0);
  EXPECT_GT(probe.force(0).y(), 0);
  probe.state().now.velocity[0] = {0, 0.05 * std::numbers::pi, 0};
  probe.evaluate(1);
  EXPECT_NEAR(probe.force(0).y(), 0, 1e-12);
}

TEST(NoSlip, CostsNothingWithoutEffect) {
  const auto has_stage = [](const Scene& scene) {
    const ForceProbe probe(scene);
    return !probe.work().of<LiquidScratch>().filled_density.empty();
  };
  Scene scene = make_wall_scene(4, {0.5, 0.5, 0.05}, {1, 0, 0});
  EXPECT_TRUE(has_stage(scene));
  scene.forces.viscosity = false;
  EXPECT_FALSE(has_stage(scene));
  scene.forces.viscosity = true;
  scene.materials[0].liquid->viscosity = 0;
  EXPECT_FALSE(has_stage(scene));
  scene.materials[0].liquid->viscosity = 1;
  scene.vat->walls[4].no_slip = false;
  EXPECT_FALSE(has_stage(scene));
}

}  // namespace
}  // namespace vat::test::no_slip_test
