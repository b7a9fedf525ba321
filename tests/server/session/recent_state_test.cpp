// Recovery of sessions from recent states, which are not synchronised.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/server/session/recovery_fixture.h"

namespace vat::test::recent_state_test {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

/// The budget admits one checkpoint. The later states are recent states.
class RecentState : public SessionRecoveryTest {
 protected:
  RecentState() {
    storage.checkpoint_after = 1ms;
    storage.checkpoint_bytes_per_second = 1;
    begin();
    client().result("control.pause");
    for (int i = 0; i < 20; ++i) {
      client().result("control.step", {{"ticks", 10}});
      client().result("world.set_gravity", {{"gravity", {0, 0.1 * i, -9}}});
      life->flush();
      clock.advance(1s);
    }
    before = life->hash();
    end_by_crash();
  }
  std::string file() const {
    for (const auto& entry : fs::directory_iterator(data + "/recent")) return entry.path();
    throw std::runtime_error("there is no recent state");
  }
  std::string before;
};

TEST_F(RecentState, IsTheStartOfARecovery) {
  const std::int64_t newest = Database(data + "/checkpoints.db", Database::Mode::read)
                                  .number("SELECT max(sequence) FROM checkpoints");
  ASSERT_LT(newest, 10);
  execute("UPDATE log SET params = 'damaged' WHERE sequence BETWEEN " + std::to_string(newest + 1) +
          " AND 10");
  begin();
  EXPECT_EQ(life->hash(), before);
  EXPECT_TRUE(client().events("session.diverged").empty());
}

TEST_F(RecentState, IsSkippedIfItIsIncomplete) {
  fs::resize_file(file(), fs::file_size(file()) / 2);
  begin();
  EXPECT_EQ(life->hash(), before);
}

// With durability "process", a power failure can lose the newest commands, and not the state.
TEST_F(RecentState, IsRemovedIfTheLogIsShorter) {
  execute("DELETE FROM log WHERE sequence > 8");
  execute("UPDATE sessions SET position = NULL, reached = 0");
  const std::int64_t tick =
      Database(data + "/vat.db", Database::Mode::read).number("SELECT max(tick) FROM log");
  begin();
  EXPECT_EQ(life->tick(), static_cast<std::uint64_t>(tick));
  EXPECT_TRUE(client().events("session.diverged").empty());
  client().result("control.step", {{"ticks", 3}});
  const std::string after = life->hash();
  crash();
  EXPECT_EQ(life->hash(), after);
}

}  // namespace
}  // namespace vat::test::recent_state_test
