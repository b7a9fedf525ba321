#include "core/liquid/surface/surface_tension.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/numerics/step_limits.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::surface_tension_test {
namespace {

constexpr Real kSpacing = 0.05;
constexpr Real kSigma = 0.5;

Scene make_wet_scene(int dimensions) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.dimensions = dimensions;
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  LiquidConstants water{100, 0, 3 * kSpacing};
  water.surface_tension = kSigma;
  scene.materials = {make_liquid("water", 1000, water)};
  return scene;
}

BodyDescription make_water(std::vector<Vec3> points, int dimensions) {
  return make_body("water", BodyKind::liquid, "water",
                   make_particles(std::move(points), 1000 * std::pow(kSpacing, dimensions)),
                   kSpacing / 2);
}

/// Lattice points within a ball, with an even number of sites per edge. Without `whole`, only those
/// above z = 0.
std::vector<Vec3> ball(Real radius, int dimensions, bool whole) {
  const int n = 2 * static_cast<int>(radius / kSpacing) + 2;
  std::vector<Vec3> points;
  for (const Vec3& p : make_lattice(n, dimensions == 3 ? n : 1, n, kSpacing)) {
    if (p.norm() < radius && (whole || p.z() > 0)) points.push_back(p);
  }
  return points;
}

// The integral of 2 |g| over the liquid is the area of the surface.
TEST(SurfaceTension, NormalsOfABallPointToItsCentreAndGradientsAddUpToItsSurface) {
  for (const int dimensions : {2, 3}) {
    const Real radius = 10 * kSpacing;
    Real area = 0;
    Scene scene = make_wet_scene(dimensions);
    scene.bodies = {make_water(ball(radius, dimensions, true), dimensions)};
    const ForceProbe probe(scene);
    const std::span<const Index> order = probe.work().of<LiquidScratch>().liquid.grid.order();
    for (std::size_t slot = 0; slot < order.size(); ++slot) {
      const Vec3& x = probe.model().bodies[0].sample->positions[order[slot]];
      const Vec3& normal = probe.work().of<SurfaceScratch>().surface_normals[slot];
      area += 2 * probe.work().of<SurfaceScratch>().surface[slot].gradient.norm() *
              std::pow(kSpacing, dimensions);

      if (x.norm() < radius - scene.materials[0].liquid->support_radius) {
        EXPECT_TRUE(normal.isZero(0)) << x.transpose();
        EXPECT_LT(probe.work().of<SurfaceScratch>().surface[slot].kernel_deficiency, 1e-12);
      } else if (x.norm() > radius - kSpacing) {
        EXPECT_LT(normal.dot(x.normalized()), -0.97) << x.transpose();  // one lattice step
        EXPECT_GT(probe.work().of<SurfaceScratch>().surface[slot].kernel_deficiency, 0.05);
      }
    }
    const Real exact = 2 * std::numbers::pi * radius * (dimensions == 3 ? 2 * radius : 1);
    EXPECT_NEAR(area / exact, 1, kSpacing / radius) << dimensions;
  }
}

// The forces in half a drop at a wall equal those in the same half of a whole drop.
TEST(SurfaceTension, WallsAreMirrors) {
  for (const int dimensions : {2, 3}) {
    Scene whole = make_wet_scene(dimensions);
    whole.bodies = {make_water(ball(0.4, dimensions, true), dimensions)};
    Scene half = make_wet_scene(dimensions);
    half.bodies = {make_water(ball(0.4, dimensions, false), dimensions)};
    half.vat = Vat{{-1, -1, 0}, {1, 1, 1}, false, {}};
    const ForceProbe of_whole(whole);
    const ForceProbe of_half(half);
    const std::vector<Vec3>& at = of_half.model().bodies[0].sample->positions;
    const std::vector<Vec3>& everywhere = of_whole.model().bodies[0].sample->positions;
    Real greatest = 0;
    for (Index i = 0; i < at.size(); ++i) {
      const auto same = std::ranges::find_if(
          everywhere, [&](const Vec3& x) { return (x - at[i]).norm() < 1e-9; });
      ASSERT_NE(same, everywhere.end());
      const Vec3& expected = of_whole.force(0, static_cast<Index>(same - everywhere.begin()));
      EXPECT_LT((of_half.force(0, i) - expected).norm(), 1e-9) << at[i].transpose();
      greatest = std::max(greatest, expected.norm());
    }
    EXPECT_GT(greatest, 1e-3);
  }
}

/// A two-dimensional layer of liquid on a floor that ends at x = 0.
Scene make_layer(Real contact_angle) {
  Scene scene = make_wet_scene(2);
  scene.vat = Vat{{-2, -1, 0}, {2, 1, 2}, false, {}};
  scene.interfaces = {{{"water", kVatMaterial}, {}, {}, contact_angle}};
  std::vector<Vec3> points = make_lattice(30, 1, 20, kSpacing);
  for (Vec3& p : points) p += Vec3(-15 * kSpacing, 0, 10 * kSpacing);
  scene.bodies = {make_water(points, 2)};
  return scene;
}

// At a distance d, the normal contains the contact normal with the weight 1 - d/h. The support
// radius h is three spacings.
TEST(SurfaceTension, NormalsTurnAtWallsToTheContactAngle) {
  for (const Real angle : {75.0, 90.0, 120.0, 150.0}) {
    const ForceProbe probe(make_layer(angle));
    const std::span<const Index> order = probe.work().of<LiquidScratch>().liquid.grid.order();
    const Real theta = angle * std::numbers::pi / 180;
    const Vec3 contact(-std::sin(theta), 0, -std::cos(theta));
    std::size_t count = 0;
    for (std::size_t slot = 0; slot < order.size(); ++slot) {
      const Vec3& x = probe.model().bodies[0].sample->positions[order[slot]];
      if (x.x() < -0.6 * kSpacing || x.z() > 3 * kSpacing) continue;
      const Real share = 1 - x.z() / (3 * kSpacing);
      const Vec3 expected = (share * contact - (1 - share) * Vec3::UnitX()).normalized();
      EXPECT_LT((probe.work().of<SurfaceScratch>().surface_normals[slot] - expected).norm(), 1e-9)
          << x.transpose();
      ++count;
    }
    EXPECT_EQ(count, 3u) << angle;
  }
}

/// Returns the force [N/m] along x on the end of the layer.
Real pull_on_layer(Real contact_angle) {
  const ForceProbe probe(make_layer(contact_angle));
  const std::vector<Vec3>& at = probe.model().bodies[0].sample->positions;
  Real sum = 0;
  for (Index i = 0; i < at.size(); ++i) {
    if (at[i].x() > -10 * kSpacing) sum += probe.force(0, i).x();
  }
  return sum;
}

// By Young's law, the force per length is sigma cos(theta). At a vertical end only a part of it
// acts. The part grows as the contact angle approaches 90 degrees.
TEST(SurfaceTension, WallsPullTowardsTheContactAngle) {
  const Real neutral = pull_on_layer(90);
  for (const Real angle : {75.0, 120.0, 150.0}) {
    const Real young = kSigma * std::cos(angle * std::numbers::pi / 180);
    const Real share = (pull_on_layer(angle) - neutral) / young;
    EXPECT_GT(share, 0.5) << angle;
    EXPECT_LT(share, 1.1) << angle;
  }
}

TEST(SurfaceTension, SolidsContinueTheLiquid) {
  Scene scene = make_wet_scene(2);
  scene.materials.push_back(make_material("stone"));
  std::vector<Vec3> points = make_lattice(20, 1, 8, kSpacing);
  BodyDescription stone =
      make_body("stone", BodyKind::rigid, "stone", make_particles(points, 1), kSpacing / 2);
  stone.position = {0, 0, -8 * kSpacing};
  scene.bodies = {make_water(points, 2), stone};
  const ForceProbe probe(scene);
  const std::span<const Index> order = probe.work().of<LiquidScratch>().liquid.grid.order();
  std::size_t count = 0;
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    const Vec3& x = probe.model().bodies[0].sample->positions[order[slot]];
    if (std::abs(x.x()) > 6 * kSpacing || x.z() > 0) continue;
    ++count;
    EXPECT_TRUE(probe.work().of<SurfaceScratch>().surface_normals[slot].isZero(0)) << x.transpose();
    EXPECT_LT(probe.work().of<SurfaceScratch>().surface[slot].kernel_deficiency, 1e-9);
  }
  EXPECT_EQ(count, 12u * 4u);
}

// Cohesion is a sum of pair forces along the connecting lines.
TEST(SurfaceTension, CohesionBalances) {
  Scene scene = make_wet_scene(3);
  scene.forces.viscosity = false;
  scene.bodies = {make_water({{0, 0, 0}, {0.07, 0.01, 0}}, 3)};
  const ForceProbe probe(scene);
  const Vec3 pull = probe.force(0, 0);
  EXPECT_GT(pull.x(), 0);
  EXPECT_LT((pull + probe.force(0, 1)).norm(), 1e-15 * pull.norm());
  EXPECT_LT(pull.cross(Vec3(0.07, 0.01, 0)).norm(), 1e-15 * pull.norm());
}

// Brackbill's limit for waves of two spacings, and the sound speed of liquid and cohesion.
TEST(SurfaceTension, LimitsSteps) {
  Scene scene = make_wet_scene(3);
  scene.materials[0].liquid->stiffness = 1e-9;
  scene.bodies = {make_water(ball(0.2, 3, true), 3)};
  const auto limits = find_step_limits(scene, sample_bodies(scene));
  ASSERT_EQ(limits.size(), 1u);
  const Real brackbill = std::sqrt(1000 * std::pow(kSpacing, 3) / (2 * std::numbers::pi * kSigma));
  EXPECT_LT(limits[0].step, brackbill);
  EXPECT_GT(limits[0].step, 0.95 * brackbill);
}

}  // namespace
}  // namespace vat::test::surface_tension_test
