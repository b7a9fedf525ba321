#include <gtest/gtest.h>

#include <mutex>

#include "server/directory/session_registry.h"

namespace vat::session_registry_test {
namespace {

// A node can lose a session during its recovery, and take it again before the recovery ends.
TEST(SessionRegistry, OnlyTheLastRecoveryOfASessionIsValid) {
  OwnedMutex mutex;
  const std::lock_guard lock(mutex);
  SessionRegistry sessions(mutex);
  const std::uint64_t first = sessions.add_absent(1, "a");
  const std::uint64_t other = sessions.add_absent(2, "b");
  ASSERT_NE(sessions.find_recovering(1, first), nullptr);
  EXPECT_EQ(sessions.find_recovering(1, first)->name, "a");
  EXPECT_EQ(sessions.find_recovering(1, other), nullptr);
  sessions.remove_absent(1);
  EXPECT_EQ(sessions.find_recovering(1, first), nullptr);
  const std::uint64_t second = sessions.add_absent(1, "c");
  EXPECT_EQ(sessions.find_recovering(1, first), nullptr);
  ASSERT_NE(sessions.find_recovering(1, second), nullptr);
  EXPECT_EQ(sessions.find_recovering(1, second)->name, "c");
}

TEST(SessionId, HasANumber) {
  for (const SessionNumber number : {SessionNumber{1}, SessionNumber{77}, kFirstReplay - 1,
                                     kFirstReplay, kFirstReplay + 3, 2 * kFirstReplay - 1}) {
    EXPECT_EQ(number_of(to_id(number)), number) << to_id(number);
  }
  EXPECT_EQ(number_of("r3"), kFirstReplay + 3);
  for (const char* const id :
       {"", "s", "r", "3", "x3", "s3 ", "s-3", "r+3", "R3", "s3x", "s4611686018427387904",
        "r4611686018427387904", "s99999999999999999999"}) {
    EXPECT_FALSE(number_of(id)) << id;
  }
}

}  // namespace
}  // namespace vat::session_registry_test
