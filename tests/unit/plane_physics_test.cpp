// What is different in the plane y = 0 of two dimensions: kernels, discs, directions and walls.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/forces/pair_direction.h"
#include "core/rigid/mass_properties.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::plane_physics_test {
namespace {

using namespace test;

constexpr Real kSupports[] = {0.04, 1.0, 3.5};

/// Integral of a radial kernel over its disc, 2 pi r W(r), by composite Gauss-Legendre of three
/// points in q = sqrt(r/h), which has no singularity where W has a logarithm.
Real integrate(Real h, const std::function<Real(Real)>& w) {
  constexpr int kPieces = 2000;
  const Real offset = std::sqrt(3.0 / 5);
  const Real half = 0.5 / kPieces;
  Real sum = 0;
  for (int piece = 0; piece < kPieces; ++piece) {
    const Real middle = (2 * piece + 1) * half;
    const auto at = [&](Real q) {
      const Real r = h * q * q;
      return 2 * std::numbers::pi * r * w(r) * 2 * h * q;
    };
    sum += half / 9 *
           (5 * at(middle - offset * half) + 8 * at(middle) + 5 * at(middle + offset * half));
  }
  return sum;
}

TEST(PlanePhysics, KernelsIntegrateToOne) {
  for (const Real h : kSupports) {
    const Poly6 poly6(h, 2);
    const Spiky spiky(h, 2);
    const ViscosityKernel viscosity(h, 2);
    EXPECT_NEAR(integrate(h, [&](Real r) { return poly6.value(r * r); }), 1, 1e-10);
    EXPECT_NEAR(integrate(h, [&](Real r) { return spiky.value(r); }), 1, 1e-10);
    EXPECT_NEAR(integrate(h, [&](Real r) { return viscosity.value(r); }), 1, 1e-10);
  }
}

TEST(PlanePhysics, LaplacianIsThatOfTheKernel) {
  for (const Real h : kSupports) {
    const ViscosityKernel kernel(h, 2);
    const Real step = 1e-3 * h;
    for (int n = 10; n < 100; ++n) {
      const Real r = h * n / 100;
      // (r W')' / r by differences of differences: they err by step^2 times derivatives of W, of
      // which the logarithm's are greatest.
      const auto flux = [&](Real s) {
        return s * (kernel.value(s + step / 2) - kernel.value(s - step / 2)) / step;
      };
      const Real difference = (flux(r + step / 2) - flux(r - step / 2)) / (step * r);
      const Real derivatives = kernel.laplacian_scale() * h * h * h / (r * r * r * r);
      EXPECT_NEAR(kernel.laplacian(r), difference, step * step * derivatives);
      EXPECT_GT(kernel.laplacian(r), 0);
    }
    EXPECT_NEAR(kernel.value(h), 0, 1e-12 / (h * h));
  }
}

TEST(PlanePhysics, LiquidHasTheDensityOfAnEndlessLattice) {
  for (const Real support : {1.5, 2.0, 3.0, 4.0}) {
    Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
    scene.dimensions = 2;
    scene.materials = {make_liquid("water", 1000, {1, 1, support})};
    scene.bodies = {make_body("water", BodyKind::liquid, "water",
                              make_particles(make_lattice(8, 1, 8, 1), 1000), 0.5)};
    scene.periodic = Periodicity{Vec3::Constant(-4), Vec3::Constant(4), {true, false, true}};
    const ForceProbe probe(scene);
    Real expected = 0;
    for (int x = -4; x <= 4; ++x) {
      for (int z = -4; z <= 4; ++z) {
        const Real rest = support * support - x * x - z * z;
        if (rest > 0) expected += 4 / std::numbers::pi * std::pow(rest, 3) / std::pow(support, 8);
      }
    }
    for (const Real density : probe.work().density) {
      EXPECT_NEAR(density, 1000 * expected, 1e-10);
    }
  }
}

TEST(PlanePhysics, ParticlesInOnePlacePartWithinIt) {
  for (Index i = 0; i < 50; ++i) {
    for (Index j = 0; j < i; ++j) {
      const Vec3 n = coincident_direction(i, j, 2);
      EXPECT_EQ(n.y(), 0);
      EXPECT_NEAR(n.norm(), 1, 1e-15);
      EXPECT_EQ(n, Vec3(-coincident_direction(j, i, 2)));
    }
  }
}

TEST(PlanePhysics, RigidBodiesAreOfDiscs) {
  SampledBody sample;
  sample.positions = {{-1, 0, 0}, {3, 0, 0}};
  sample.masses = {3, 1};
  sample.radii = {0.5, 0.2};
  const MassProperties p = plane_mass_properties(sample);
  EXPECT_EQ(p.mass, 4);
  EXPECT_EQ(p.center_of_mass, Vec3::Zero());
  EXPECT_NEAR(p.inertia(1, 1), 3 * 1 + 1 * 9 + 0.5 * (3 * 0.25 + 1 * 0.04), 1e-14);
  EXPECT_EQ(p.inertia, Mat3(p.inertia(1, 1) * Mat3::Identity()));
}

TEST(PlanePhysics, DiscHasTheAngularMomentumOfOne) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.dimensions = 2;
  scene.materials = {make_material("solid")};
  scene.bodies = {make_body("disc", BodyKind::rigid, "solid", make_particles({{0, 0, 0}}, 2), 0.5)};
  scene.bodies[0].angular_velocity = {0, 3, 0};
  const Simulation simulation = make_simulation(scene);
  EXPECT_NEAR(simulation.diagnostics().bodies[0].angular_momentum.y(), 0.5 * 2 * 0.25 * 3, 1e-14);
}

// All kinds of bodies on one another, two particles of the liquid in one place.
TEST(PlanePhysics, NothingLeavesItInAThousandSteps) {
  for (const IntegratorId integrator : kIntegrators) {
    Scene scene = make_scene(integrator, 2e-4);
    scene.dimensions = 2;
    scene.gravity = {0.3, 0, -9.81};
    scene.materials = {make_liquid("water", 1000, {20, 1, 0.1}), make_material("solid")};
    scene.default_interface = {2000, 2};
    scene.vat = Vat{Vec3(-0.5, -0.01, -0.3), Vec3(0.5, 0.01, 0.7), true, {}, {}};
    scene.vat->walls[4] = {true, {0.5, 0, 0}};
    EXPECT_EQ(ForceProbe(scene).model().walls, (std::vector<int>{0, 1, 4, 5}));
    std::vector<Vec3> points = make_lattice(4, 1, 4, 0.05);
    const auto add = [&](const char* name, BodyKind kind, const char* material, Real x, Real z) {
      scene.bodies.push_back(make_body(name, kind, material, make_particles(points, 2), 0.025));
      scene.bodies.back().position = {x, 0, z};
      scene.bodies.back().angular_velocity = {0, 5 * x, 0};
      scene.bodies.back().orientation = Quat(Eigen::AngleAxis<Real>(0.3 + x, Vec3::UnitY()));
    };
    add("cloth", BodyKind::deformable, "solid", -0.1, 0.06);
    scene.bodies[0].springs = join_near(points, 0.08, {300, 1});
    add("ball", BodyKind::rigid, "solid", 0.1, 0.06);
    add("rock", BodyKind::rigid, "solid", 0.02, 0.3);
    points[1] = points[0];
    add("pool", BodyKind::liquid, "water", -0.15, -0.15);
    Simulation simulation = make_simulation(scene);
    ASSERT_FALSE(simulation.advance(1000).failed);
    for (const BodyView& body : simulation.bodies()) {
      for (std::size_t i = 0; i < body.positions.size(); ++i) {
        ASSERT_EQ(body.positions[i].y(), 0) << to_string(integrator) << ' ' << body.name;
        ASSERT_EQ(body.velocities[i].y(), 0) << to_string(integrator) << ' ' << body.name;
      }
    }
  }
}

}  // namespace
}  // namespace vat::plane_physics_test
