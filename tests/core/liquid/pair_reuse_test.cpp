#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"

// Pairs and densities are reused if no position has changed.

namespace vat::test::pair_reuse_test {
namespace {

Scene make_wet_vat() {
  Scene scene = make_wet_mixture(IntegratorId::velocity_verlet, PressureSolver::tait);
  scene.pair_precision = PairPrecision::single_precision;
  scene.vat = Vat{Vec3::Constant(-0.2), Vec3::Constant(0.6), true, SlideMotion{{1, 0, 0}, 0.1, 1}};
  return scene;
}

void expect_forces_of_a_new_workspace(ForceProbe& probe, Real time) {
  Workspace fresh;
  Forces forces = probe.state().forces;
  Configuration now = probe.state().now;
  ForceModel{probe.model(), {}, fresh}.evaluate(now, time, forces);
  probe.evaluate(time);
  EXPECT_EQ(probe.state().forces.particle, forces.particle);
}

TEST(PairReuse, SearchesNothingWithoutMotion) {
  ForceProbe probe(make_wet_vat());
  const std::uint64_t version = probe.work().of<LiquidScratch>().sources.version();
  ASSERT_GT(version, 0U);
  for (Vec3& velocity : probe.state().now.velocity) velocity += Vec3(0.1, 0, 0.2);
  expect_forces_of_a_new_workspace(probe, 0);
  EXPECT_EQ(probe.work().of<LiquidScratch>().sources.version(), version);
}

TEST(PairReuse, SeesTheLeastMotionOfLiquidsSolidsAndWalls) {
  ForceProbe probe(make_wet_vat());
  std::uint64_t version = probe.work().of<LiquidScratch>().sources.version();
  const auto expect_new = [&](Real time) {
    expect_forces_of_a_new_workspace(probe, time);
    EXPECT_GT(probe.work().of<LiquidScratch>().sources.version(), version);
    version = probe.work().of<LiquidScratch>().sources.version();
  };
  const auto nudge = [&](std::size_t body) {
    Real& x = probe.state().now.position[probe.model().bodies[body].particles.begin].x();
    x = std::nextafter(x, std::numeric_limits<Real>::infinity());
  };
  nudge(1);  // oil
  expect_new(0);
  nudge(2);  // jelly
  expect_new(0);
  expect_new(0.1);  // the vat has slid
}

}  // namespace
}  // namespace vat::test::pair_reuse_test
