#include "core/solid/volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/laws/cell_volume.h"
#include "core/numerics/step_limits.h"
#include "core/validation/validate.h"
#include "tests/support/errors.h"
#include "tests/support/force_probe.h"
#include "tests/support/same_bits.h"
#include "tests/support/scenes.h"

namespace vat::test::volume_test {
namespace {

constexpr std::array<Index, 8> kCorners{0, 1, 2, 3, 4, 5, 6, 7};

/// The corners of a brick of 1 x 2 x 3, mapped by `place`.
template <class F>
std::vector<Vec3> make_cell(F&& place) {
  std::vector<Vec3> at;
  for (int c = 0; c < 8; ++c) at.push_back(place(Vec3(c & 1, 2 * (c >> 1 & 1), 3 * (c >> 2))));
  return at;
}

Vec3 bend(const Vec3& x) {
  return x + Vec3(0.3 * x.y() * x.z(), 0.2 * x.x() * x.z(), -0.1 * x.x() * x.y() * x.z());
}

TEST(CellVolume, IsTheDeterminantOfALinearMap) {
  const Mat3 map = (Mat3() << 1, 0.2, 0, -0.3, 2, 0.5, 0.1, 0, 0.7).finished();
  const auto at = make_cell([&](const Vec3& x) { return Vec3(map * x + Vec3(1e3, 0, -5)); });
  EXPECT_NEAR(cell_volume(at, kCorners, 3), 6 * map.determinant(), 1e-10);
  const auto inside_out = make_cell([](const Vec3& x) { return Vec3(-x); });
  EXPECT_NEAR(cell_volume(inside_out, kCorners, 3), -6, 1e-14);
}

TEST(CellVolume, IsThatBetweenBilinearFaces) {
  // x -> x (1 + a y z): the integral of 1 + a y z over 1 x 2 x 3 is 6 + a 2^2/2 3^2/2.
  const auto at = make_cell(
      [](const Vec3& x) { return Vec3(x.x() * (1 + 0.1 * x.y() * x.z()), x.y(), x.z()); });
  EXPECT_NEAR(cell_volume(at, kCorners, 3), 6 + 0.1 * 9, 1e-14);
}

TEST(CellVolume, HasTheSlopeOfItsDifferences) {
  for (const int dimensions : {2, 3}) {
    std::vector<Vec3> at = make_cell(bend);
    if (dimensions == 2) at = {{0, 0, 0}, {1.1, 0, 0.2}, {-0.1, 0, 0.9}, {1.3, 0, 1.2}};
    Vec3 sum = Vec3::Zero();
    Vec3 torque = Vec3::Zero();
    for (Index c = 0; c < at.size(); ++c) {
      const Vec3 slope = cell_slope(at, kCorners, c, dimensions);
      sum += slope;
      torque += at[c].cross(slope);
      for (int axis = 0; axis < 3; ++axis) {
        if (dimensions == 2 && axis == 1) continue;
        constexpr Real kShift = 1e-3;  // the volume is linear in each coordinate
        std::vector<Vec3> moved = at;
        moved[c][axis] += kShift;
        const Real difference =
            cell_volume(moved, kCorners, dimensions) - cell_volume(at, kCorners, dimensions);
        EXPECT_NEAR(slope[axis], difference / kShift, 1e-11) << c << ' ' << axis;
      }
    }
    EXPECT_LT(sum.norm(), 1e-14);
    EXPECT_LT(torque.norm(), 1e-13);
  }
}

TEST(CellVolume, IsTheAreaInThePlane) {
  const std::vector<Vec3> at{{0, 0, 0}, {2, 0, 0}, {0, 0, 1}, {3, 0, 2}};
  EXPECT_NEAR(cell_volume(at, kCorners, 2), 3.5, 1e-15);  // sum of triangles: 2 + 1.5
}

/// A sampled block without springs, deformed by a linear map.
Scene make_block(const Mat3& stretch, int dimensions = 3) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.dimensions = dimensions;
  scene.materials = {make_material("jelly")};
  scene.materials[0].bulk_modulus = 1000;
  BodyDescription block{"block", BodyKind::deformable, "jelly",
                        BoxShape{{0, 0, 0}, {0.3, dimensions == 3 ? 0.4 : 0.1, 0.5}}, 0.1};
  block.displacement_field = VectorField{Vec3::Zero(), stretch - Mat3::Identity(), {}};
  scene.bodies = {block};
  return scene;
}

TEST(Volume, HasTheEnergyOfTheCompression) {
  const Mat3 stretch = Vec3(1.1, 0.9, 0.8).asDiagonal();
  const Real change = stretch.determinant() - 1;
  EXPECT_NEAR(make_simulation(make_block(stretch)).diagnostics().elastic_energy,
              0.5 * 1000 * 2 * 3 * 4 * 0.001 * change * change, 1e-12);
  const Mat3 plane = Vec3(1.1, 1, 0.8).asDiagonal();
  EXPECT_NEAR(make_simulation(make_block(plane, 2)).diagnostics().elastic_energy,
              0.5 * 1000 * 2 * 4 * 0.01 * 0.12 * 0.12, 1e-12);
}

TEST(Volume, HasNoForceIfItIsKept) {
  const Mat3 shear = (Mat3() << 2, 0.3, 0, 0, 0.5, 0, 0, 0, 1).finished();
  const ForceProbe probe(make_block(shear));
  for (Index i = 0; i < 60; ++i) EXPECT_LT(probe.force(0, i).norm(), 1e-12);
  const ForceProbe pressed(make_block(0.9 * Mat3::Identity()));
  // The first corner carries one third of a quarter of three faces, each of (0.09 m)^2.
  const Real pressure = 1000 * (1 - 0.729);
  EXPECT_LT((pressed.force(0, 0) + pressure * 0.0081 / 4 * Vec3::Ones()).norm(), 1e-12);
}

TEST(Volume, KeepsMomentumAndEnergy) {
  for (const int dimensions : {2, 3}) {
    Mat3 stretch = Vec3(1.1, 1, 0.8).asDiagonal();
    stretch(0, 2) = 0.2;
    Scene scene = make_block(stretch, dimensions);
    scene.materials[0].springs = LatticeSprings{{{50, 0}}, {{50, 0}}, {}};
    scene.materials[0].density = 100;
    scene.bodies[0].velocity = {0.1, 0, 0.2};
    scene.bodies[0].angular_velocity = {0, 2, 0};
    Simulation simulation = make_simulation(scene);
    const Diagnostics start = simulation.diagnostics();
    simulation.advance(2000);
    const Diagnostics end = simulation.diagnostics();
    EXPECT_LT((end.bodies[0].linear_momentum - start.bodies[0].linear_momentum).norm(), 1e-12);
    EXPECT_LT((end.bodies[0].angular_momentum - start.bodies[0].angular_momentum).norm(), 1e-12);
    // Velocity Verlet: at most (omega dt)^2 / 4, with omega dt = 0.2 of the cells' sound.
    EXPECT_NEAR(
        (end.kinetic_energy + end.elastic_energy) / (start.kinetic_energy + start.elastic_energy),
        1, 0.01);
  }
}

TEST(Volume, BoundsTheStep) {
  Scene scene = make_block(0.99 * Mat3::Identity());
  scene.materials[0].bulk_modulus = 1e5;
  const std::vector<StepLimit> limits = find_step_limits(scene, sample_bodies(scene));
  ASSERT_EQ(limits.size(), 1U);
  EXPECT_EQ(limits[0].path, "/bodies/0");
  for (const Real part : {0.95, 4.0}) {
    Scene run = scene;
    run.numerics.step = run.numerics.tick = part * limits[0].step;
    Simulation simulation = make_simulation(run);
    const Real start = simulation.diagnostics().elastic_energy;
    bool is_stable = true;
    for (int n = 0; n < 300 && is_stable; ++n) {
      is_stable = simulation.advance(1).undone_steps == 0;
      const Diagnostics now = simulation.diagnostics();
      is_stable = is_stable && now.kinetic_energy + now.elastic_energy < 3 * start;
    }
    EXPECT_EQ(is_stable, part < 1) << part;
  }
}

TEST(Volume, HasTheSameBitsForAnyThreads) {
  Scene scene = make_block(0.9 * Mat3::Identity());
  scene.bodies[0].spacing = 0.03;
  scene.materials[0].springs = LatticeSprings{{{50, 0.1}}, {{50, 0.1}}, {}};
  for (const bool implicit : {false, true}) {
    scene.materials[0].implicit_springs = implicit;
    scene.numerics.control = implicit ? StepControl::adaptive : StepControl::fixed;
    expect_same_bits(scene, 10, 5);
  }
}

TEST(Volume, IsNotKeptIfSpringsTear) {
  Scene scene = make_block(Mat3::Identity());
  scene.materials[0].tearing_strain = 0.5;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /materials/0/bulk_modulus");
}

}  // namespace
}  // namespace vat::test::volume_test
