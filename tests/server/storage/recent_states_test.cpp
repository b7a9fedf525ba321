// Recent states: one file per session, replaced by each write.

#include "server/storage/recent_states.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace vat::test::recent_states_test {
namespace {

namespace fs = std::filesystem;

Checkpoint state_at(std::uint64_t session, std::uint64_t position) {
  return {session, position, position + 1, "{}", std::vector<std::uint8_t>(100, 7)};
}

class RecentStatesTest : public testing::Test {
 protected:
  std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(path)) ++count;
    return count;
  }
  /// Returns the position of the stored state, or 0.
  static std::uint64_t position(RecentStates& states, std::uint64_t session) {
    const auto state = states.read(session);
    return state ? state->position : 0;
  }

  const TemporaryFolder folder;
  const std::string path = folder.file("recent");
};

TEST_F(RecentStatesTest, HasTheNewestStateAlsoAfterARestart) {
  RecentStates states(path, 1 << 20);
  EXPECT_FALSE(states.read(1));
  for (const std::uint64_t position : {5U, 6U, 7U}) {
    EXPECT_TRUE(states.write(state_at(1, position)));
    EXPECT_TRUE(states.write(state_at(2, 10 * position)));
    EXPECT_EQ(files(), 2U);
  }
  RecentStates again(path, 1 << 20);
  const auto state = again.read(1);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->session, 1U);
  EXPECT_EQ(state->position, 7U);
  EXPECT_EQ(state->sequence, 8U);
  EXPECT_EQ(state->fields, "{}");
  EXPECT_EQ(state->state, state_at(1, 7).state);
  EXPECT_TRUE(again.write(state_at(1, 8)));
  EXPECT_EQ(position(again, 1), 8U);
  EXPECT_EQ(files(), 2U);
  again.remove(1);
  EXPECT_EQ(position(again, 1), 0U);
  EXPECT_EQ(position(again, 2), 70U);
}

// The process can end between the write of a file and the removal of the previous one.
TEST_F(RecentStatesTest, OfTwoFilesTheNewestCompleteOneCounts) {
  { RecentStates(path, 1 << 20).write(state_at(1, 5)); }
  ASSERT_EQ(files(), 1U);
  const std::string first = fs::directory_iterator(path)->path();
  const std::string kept = folder.file("kept");
  fs::copy(first, kept);
  { RecentStates(path, 1 << 20).write(state_at(1, 6)); }
  const std::string second = fs::directory_iterator(path)->path();
  ASSERT_NE(first, second);
  fs::copy(kept, first);
  {
    RecentStates states(path, 1 << 20);
    EXPECT_EQ(position(states, 1), 6U);
  }
  std::ofstream(second, std::ios::app) << "more";
  RecentStates states(path, 1 << 20);
  EXPECT_EQ(position(states, 1), 5U);
  EXPECT_TRUE(states.write(state_at(1, 7)));
  EXPECT_EQ(position(states, 1), 7U);
  EXPECT_EQ(files(), 1U);
}

TEST_F(RecentStatesTest, StaysWithinItsBytes) {
  { RecentStates(path, 1 << 20).write(state_at(1, 1)); }
  const std::size_t size = fs::file_size(fs::directory_iterator(path)->path());
  RecentStates states(path, 2 * size);
  EXPECT_TRUE(states.write(state_at(2, 1)));
  EXPECT_TRUE(states.write(state_at(1, 2))) << "it replaces the previous one";
  EXPECT_FALSE(states.write(state_at(3, 1)));
  EXPECT_EQ(position(states, 3), 0U);
  states.keep_only({2});
  EXPECT_EQ(position(states, 1), 0U);
  EXPECT_TRUE(states.write(state_at(3, 2)));
  EXPECT_EQ(position(states, 2), 1U);
}

TEST_F(RecentStatesTest, AnotherFileIsNoState) {
  fs::create_directories(path);
  std::ofstream(path + "/1.0") << "no state";
  std::ofstream(path + "/notes") << "of somebody";
  RecentStates states(path, 1 << 20);
  EXPECT_FALSE(states.read(1));
  EXPECT_TRUE(states.write(state_at(1, 1)));
  EXPECT_EQ(position(states, 1), 1U);
  states.keep_only({});
  EXPECT_TRUE(fs::exists(path + "/notes"));
}

}  // namespace
}  // namespace vat::test::recent_states_test
