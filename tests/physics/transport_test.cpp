#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/force_probe.h"
#include "tests/support/same_bits.h"

// Liquids that fill their world. Their particles move with a transport velocity.

namespace vat::transport_test {
namespace {

using namespace test;

/// u = -U cos(2 pi x) sin(2 pi z), w = U sin(2 pi x) cos(2 pi z) with U = 1 m/s in the plane.
VectorField vortices() {
  VectorField field;
  const Vec3 k(2 * M_PI, 0, 2 * M_PI);
  const Vec3 l(2 * M_PI, 0, -2 * M_PI);
  field.waves = {{{-0.5, 0, 0.5}, k, 0}, {{0.5, 0, 0.5}, l, 0}};
  return field;
}

/// LIQ-6: four vortices in a periodic plane of 1 m by 1 m.
Scene make_vortices(Real spacing, Real viscosity, Real jitter) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 2e-3 * spacing / 0.02);
  scene.dimensions = 2;
  scene.pressure_solver = PressureSolver::tait;
  scene.materials = {make_liquid("water", 1000, {100, viscosity, 3 * spacing, 0})};
  scene.periodic = Periodicity{{0, 0, 0}, {1, 0, 1}, {true, false, true}};
  BodyDescription water{"water", BodyKind::liquid, "water", BoxShape{{0.5, 0, 0.5}, {1, 1, 1}},
                        spacing};
  water.velocity_field = vortices();
  water.jitter = jitter;
  water.seed = 1;
  scene.bodies = {water};
  return scene;
}

TEST(Transport, KeepsMomentumAndBits) {
  Scene scene = make_vortices(0.1, 1, 0.3);
  scene.pair_precision = PairPrecision::double_precision;
  Simulation simulation = make_simulation(scene);
  const auto momentum = [&] { return simulation.diagnostics().bodies[0].linear_momentum; };
  const Vec3 before = momentum();
  simulation.advance(100);
  Real size = 0;
  const BodyView water = simulation.bodies()[0];
  for (const Vec3& v : water.velocities) size += 1000 * 0.01 * v.norm();
  EXPECT_GT(size, 100);
  EXPECT_LT((momentum() - before).norm(), 1e-12 * size);
  expect_same_bits(scene, 20, 10);
}

// One vortex between four walls behaves like one of a lattice of mirror images. Walls are
// frictionless, so there is no viscosity.
TEST(Transport, WallsAreMirrors) {
  Scene periodic = make_vortices(0.05, 0, 0);
  periodic.pair_precision = PairPrecision::double_precision;
  Scene walled = periodic;
  walled.periodic.reset();
  walled.vat = Vat{{0.25, -1, 0.25}, {0.75, 1, 0.75}, true, {}};
  walled.bodies[0].shape = BoxShape{{0.5, 0, 0.5}, {0.5, 1, 0.5}};
  Simulation whole = make_simulation(periodic);
  Simulation quarter = make_simulation(walled);
  whole.advance(30);
  quarter.advance(30);
  // The first particle of the quarter is in the sixth row and column of twenty.
  EXPECT_LT((position_of(quarter, 0) - position_of(whole, 0, 5 * 20 + 5)).norm(), 1e-10);
  EXPECT_GT((position_of(quarter, 0) - Vec3(0.275, 0, 0.275)).norm(), 1e-3);
}

std::vector<std::string_view> stages_of(const Scene& scene) {
  std::vector<std::string_view> names;
  const ForceProbe probe(scene);
  for (const Stage& stage : probe.model().plan.stages) names.push_back(stage.name);
  return names;
}

// Scenes that may have a free surface have no transport stage.
TEST(Transport, IsOfLiquidsThatFillTheirWorld) {
  using testing::Contains;
  using testing::Not;
  Scene scene = make_vortices(0.1, 1, 0.3);
  EXPECT_THAT(stages_of(scene), Contains("transport_velocity"));
  scene.bodies[0].shape = BoxShape{{0.5, 0, 0.45}, {1, 1, 0.9}};
  EXPECT_THAT(stages_of(scene), Not(Contains("transport_velocity")));
  scene.periodic.reset();
  scene.vat = Vat{{0, -1, 0}, {1, 1, 0.9}, true, {}};
  EXPECT_THAT(stages_of(scene), Contains("transport_velocity"));
  scene.vat->lid = false;
  EXPECT_THAT(stages_of(scene), Not(Contains("transport_velocity")));
}

}  // namespace
}  // namespace vat::transport_test
