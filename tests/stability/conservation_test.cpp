#include <gtest/gtest.h>

#include <iostream>

#include "tests/stability/closed_pairs.h"

namespace vat::stability::conservation_test {
namespace {

TEST(ClosedPairs, KeepMomentumAndAngularMomentumOverTenThousandSteps) {
  for (const Scene& scene : closed_pairs()) {
    const ClosedRun run = run_closed(scene, 10000);
    std::cout << run.name << ": |dP| " << run.momentum << ", |dL| " << run.angular_momentum << '\n';
    EXPECT_GT(run.contact_energy, 0.01) << run.name;
    EXPECT_GT(run.exchanged, 0.05) << run.name;
    EXPECT_EQ(run.undone, 0U) << run.name;
    EXPECT_LE(run.momentum, 1e-12) << run.name;
    EXPECT_LE(run.angular_momentum, 1e-10) << run.name;
  }
}

// Shows that the test detects a force without reaction: an external force has the same effect.
TEST(ClosedPairs, NoticeAForceFromOutside) {
  Scene scene = make_closed_pair(BodyKind::deformable, BodyKind::rigid);
  scene.gravity = {0, 0, -1e-9};
  const ClosedRun run = run_closed(scene, 100);
  EXPECT_GT(run.momentum, 1e-12);
}

}  // namespace
}  // namespace vat::stability::conservation_test
