#include "core/liquid/surface/cohesion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/kernels/lattice_sum.h"
#include "core/laws/surface_tension.h"
#include "tests/core/kernels/quadrature.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::cohesion_test {
namespace {

constexpr Real kSpacing = 0.05;
constexpr Real kSupport = 3 * kSpacing;
constexpr Real kSigma = 0.5;

// The energies of layers of a continuous liquid that relax below a free surface or at a wall. The
// profile of the layers was computed for 10 layers per support radius, to 3 %.
TEST(CohesionConstants, AreThoseOfSurfacesAtRest) {
  EXPECT_EQ(kRelaxation, 1.52);
  for (const auto& [cosine, share] :
       {std::pair{-0.7, 0.561}, {-0.3, 0.698}, {0.0, 0.796}, {0.4, 0.921}, {0.8, 1.039}}) {
    EXPECT_NEAR(adhesion_share(cosine), share, 1e-3) << cosine;
  }
}

TEST(CohesionKernel, NeitherPullsNorPressesOnALattice) {
  for (const int dimensions : {2, 3}) {
    const CohesionKernel kernel(kSupport, kSpacing, dimensions);
    const auto slope = [&](Real share) {
      return sum_over_lattice(kernel.reach(), kSpacing, dimensions, [&](Real x, Real r) {
        return x * x * kernel.slope_over_r(r, share);
      });
    };
    EXPECT_NEAR(slope(1), 0, 1e-12) << dimensions;
    EXPECT_NEAR(slope(1) - slope(0), -1, 2e-3) << dimensions;  // far part only
  }
}

// By the force between two particles, gamma = pi/8 int r^4 f dr in space (Kirkwood and Buff 1949)
// and, in the same way, 1/3 int r^3 f dr in the plane.
TEST(CohesionKernel, MakesTheSurfaceTensionOfKirkwoodAndBuff) {
  for (const int dimensions : {2, 3}) {
    const CohesionKernel kernel(kSupport, kSpacing / 8, dimensions);
    const Real sum = integrate(0, kernel.reach(), [&](Real r) {
      const Real force = -r * kernel.slope_over_r(r);
      return dimensions == 3 ? std::numbers::pi / 8 * std::pow(r, 4) * force
                             : std::pow(r, 3) * force / 3;
    });
    const Real attraction = attraction_of(kSigma, kSupport, dimensions);
    EXPECT_NEAR(kRelaxation * attraction * sum, kSigma, 1e-3 * kSigma) << dimensions;
  }
}

// Compares the attraction of a half space with the sum of its parts.
TEST(CohesionKernel, OverAPlaneIsTheForceOfAHalfSpace) {
  for (const int dimensions : {2, 3}) {
    const CohesionKernel kernel(kSupport, kSpacing, dimensions);
    const Real fine = kernel.reach() / (dimensions == 3 ? 40 : 400);
    for (const Real share : {1.0, 0.6}) {
      for (const Real distance : {0.1, 0.5, 1.1, 1.7}) {
        const Real d = distance * kSupport;
        const auto first = std::ceil(d / fine);
        const Real exact = sum_over_lattice(kernel.reach(), fine, dimensions, [&](Real x, Real r) {
          return x > (first - 0.5) * fine ? x * kernel.slope_over_r(r, share) : 0;
        });
        const Real value = kernel.over_plane((first - 0.5) * fine, share);
        EXPECT_NEAR(value, -exact, 0.01 / kSupport) << dimensions << ' ' << distance;
      }
    }
  }
}

Scene make_wet_scene(int dimensions) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.dimensions = dimensions;
  scene.gravity.setZero();
  scene.pressure_solver = PressureSolver::tait;
  scene.pair_precision = PairPrecision::double_precision;
  scene.surface_model = SurfaceModel::cohesion;
  LiquidConstants water{100, 0, kSupport};
  water.surface_tension = kSigma;
  scene.materials = {make_liquid("water", 1000, water), make_material("stone")};
  return scene;
}

BodyDescription make_water(std::vector<Vec3> points, int dimensions) {
  return make_body("water", BodyKind::liquid, "water",
                   make_particles(std::move(points), 1000 * std::pow(kSpacing, dimensions)),
                   kSpacing / 2);
}

// Beyond the support radius, two particles exert no pressure.
TEST(Cohesion, OfTwoParticlesIsTheKernels) {
  for (const int dimensions : {2, 3}) {
    Scene scene = make_wet_scene(dimensions);
    scene.bodies = {make_water({{0, 0, 0}, {1.3 * kSupport, 0, 0}}, dimensions)};
    const ForceProbe probe(scene);
    const Real volume = std::pow(kSpacing, dimensions);
    const Real r = 1.3 * kSupport;
    const Real expected = -attraction_of(kSigma, kSupport, dimensions) * volume * volume * r *
                          CohesionKernel(kSupport, kSpacing, dimensions).slope_over_r(r);
    EXPECT_GT(expected, 0);
    EXPECT_NEAR(probe.force(0, 0).x(), expected, 1e-12 * expected);
    EXPECT_EQ(probe.force(0, 0), Vec3(-probe.force(0, 1)));
  }
}

// A liquid and a solid with the same volume and A differ only in the share of the far part.
TEST(Cohesion, PullsASolidAsItIsPulled) {
  for (const Real angle : {40.0, 90.0, 130.0}) {
    Scene scene = make_wet_scene(3);
    scene.interfaces = {{{"stone", "water"}, {}, {}, angle}};
    const Real r = 1.3 * kSupport;
    BodyDescription stone = make_body("stone", BodyKind::deformable, "stone",
                                      make_particles({{r, 0, 0}}, 1), kSpacing / 2);
    scene.bodies = {make_water({{0, 0, 0}}, 3), stone};
    const ForceProbe probe(scene);
    const Real volume = std::pow(kSpacing, 3);
    const Real share = adhesion_share(std::cos(angle * std::numbers::pi / 180));
    const Real expected = -attraction_of(kSigma, kSupport, 3) * volume * volume * r *
                          CohesionKernel(kSupport, kSpacing, 3).slope_over_r(r, share);
    EXPECT_NEAR(probe.force(0).x(), expected, 1e-12 * expected) << angle;
    EXPECT_EQ(probe.force(0), Vec3(-probe.force(1)));
  }
}

// If the forces derive from an energy, the stiffness matrix is symmetric. The liquid is at a wall,
// with pressure, at rest and under tension.
TEST(Cohesion, DerivesFromAnEnergy) {
  Scene scene = make_wet_scene(2);
  scene.vat = Vat{{-1, -1, 0}, {1, 1, 1}, false, {}};
  std::vector<Vec3> points;
  for (const Vec3& p : make_lattice(4, 1, 4, 1.02 * kSpacing)) {
    const Real shift = 0.1 * kSpacing * std::sin(40 * p.x() + 70 * p.z());
    points.push_back(p + Vec3(shift, 0, 3 * kSpacing + shift));
  }
  scene.bodies = {make_water(points, 2)};
  ForceProbe probe(scene);
  constexpr Real kStep = 1e-7;
  Real greatest = 0;
  const auto slope = [&](Index moved, int axis, Index other, int component) {
    Real& x = probe.state().now.position[moved][axis];
    const Real before = x;
    std::array<Real, 2> force{};
    for (const std::size_t side : {0u, 1u}) {
      x = before + (side == 0 ? -kStep : kStep);
      probe.evaluate();
      force[side] = probe.force(0, other)[component];
    }
    x = before;
    return (force[1] - force[0]) / (2 * kStep);
  };
  for (const auto& [i, j] : {std::pair<Index, Index>{0, 1}, {5, 6}, {5, 10}, {3, 9}}) {
    for (const int a : {0, 2}) {
      for (const int b : {0, 2}) {
        const Real there = slope(i, a, j, b);
        const Real back = slope(j, b, i, a);
        greatest = std::max(greatest, std::abs(there));
        EXPECT_NEAR(there, back, 2e-6 * std::max(greatest, 1.0)) << i << ' ' << j;
      }
    }
  }
  EXPECT_GT(greatest, 1);
}

}  // namespace
}  // namespace vat::test::cohesion_test
