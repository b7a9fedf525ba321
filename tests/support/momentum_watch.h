#pragma once

#include <gtest/gtest.h>

#include "tests/support/totals.h"

namespace vat::test {

/// The momenta of a simulation at construction.
class MomentumWatch {
 public:
  explicit MomentumWatch(const Simulation& simulation)
      : simulation_(simulation),
        before_(totals_of(simulation.diagnostics())),
        motion_(motion_of(simulation)) {}

  /// Expects that the momenta are unchanged. Tolerances are relative to the sums over all
  /// particles.
  void expect_momentum(Real tolerance = 1e-12) const {
    const Vec3 now = totals_of(simulation_.diagnostics()).momentum;
    EXPECT_LT((now - before_.momentum).norm(), tolerance * motion_.momentum);
  }
  void expect_angular_momentum(Real tolerance) const {
    const Vec3 now = totals_of(simulation_.diagnostics()).angular_momentum;
    EXPECT_LT((now - before_.angular_momentum).norm(), tolerance * motion_.angular_momentum);
  }

 private:
  const Simulation& simulation_;
  Totals before_;
  Motion motion_;
};

}  // namespace vat::test
