#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/scenes.h"
#include "tests/support/thread_runner.h"

namespace vat::test {

/// Expects that a simulation restored from the bytes of a snapshot continues identically: the same
/// hashes for `ticks` ticks, and the same bytes at the end. `each` acts on both before each tick.
template <class Each>
void expect_goes_on(Simulation& simulation, int ticks, Each&& each) {
  const std::vector<std::uint8_t> bytes = simulation.snapshot().to_bytes();
  ThreadRunner runner(2);
  Result<Simulation> loaded = Simulation::load(bytes, &runner);
  ASSERT_TRUE(loaded.ok()) << loaded.errors()[0].path << ' ' << loaded.errors()[0].message;
  Simulation& other = loaded.value();
  EXPECT_EQ(other.snapshot().to_bytes(), bytes);
  EXPECT_EQ(other.instruction_set(), simulation.instruction_set());
  EXPECT_EQ(other.time(), simulation.time());
  for (int tick = 0; tick < ticks; ++tick) {
    each(simulation);
    each(other);
    const AdvanceReport report = simulation.advance(simulation.steps_per_tick());
    const AdvanceReport same = other.advance(other.steps_per_tick());
    EXPECT_EQ(same.steps, report.steps);
    EXPECT_EQ(same.undone_steps, report.undone_steps);
    EXPECT_EQ(same.failed, report.failed);
    ASSERT_EQ(other.state_hash(), simulation.state_hash()) << "tick " << tick;
  }
  ASSERT_EQ(other.bodies().size(), simulation.bodies().size());
  for (std::size_t b = 0; b < other.bodies().size(); ++b) {
    const BodyView one = simulation.bodies()[b];
    const BodyView same = other.bodies()[b];
    EXPECT_EQ(same.id, one.id);
    EXPECT_EQ(same.is_asleep, one.is_asleep);
    EXPECT_TRUE(std::ranges::equal(same.positions, one.positions));
    EXPECT_TRUE(std::ranges::equal(same.numbers, one.numbers));
  }
  EXPECT_EQ(other.snapshot().to_bytes(), simulation.snapshot().to_bytes());
}

inline void expect_goes_on(Simulation& simulation, int ticks) {
  expect_goes_on(simulation, ticks, [](Simulation&) {});
}

}  // namespace vat::test
