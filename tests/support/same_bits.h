#pragma once

#include <gtest/gtest.h>

#include "tests/support/scenes.h"
#include "tests/support/thread_runner.h"

namespace vat::test {

/// Expects the same bits for any number of threads after `before` steps, and after restoring a
/// snapshot from then. The following `after` steps are requested in different portions.
inline void expect_same_bits(const Scene& scene, std::uint32_t before, std::uint32_t after) {
  Simulation serial = make_simulation(scene);
  serial.advance(before);
  for (const std::size_t threads : {2u, 4u}) {
    ThreadRunner runner(threads);
    Simulation threaded = make_simulation(scene, &runner);
    threaded.advance(before);
    EXPECT_EQ(threaded.state_hash(), serial.state_hash());
  }
  const Snapshot middle = serial.snapshot();
  serial.advance(after);
  const std::uint64_t end = serial.state_hash();
  serial.restore(middle);
  for (std::uint32_t n = 0; n < after; ++n) serial.advance(1);
  EXPECT_EQ(serial.state_hash(), end);
}

}  // namespace vat::test
