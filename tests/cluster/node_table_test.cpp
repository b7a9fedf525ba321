#include "server/cluster/node_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/manual_clock.h"

namespace vat::test::node_table_test {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::UnorderedElementsAre;

NodeInfo make_node(const std::string& name) {
  return {name, "1", "ws://" + name + "/ws", "baseline", "1.0", 2.5, true};
}

TEST(NodeTableTest, ANodeIsReadAsItWasWritten) {
  const auto read = read_node("a", write_node(make_node("a")));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->name, "a");
  EXPECT_EQ(read->url, "ws://a/ws");
  EXPECT_EQ(read->room, 2.5);
  EXPECT_TRUE(read->accepts);
  EXPECT_TRUE(read->replays.empty());
  NodeInfo with_replays = make_node("a");
  with_replays.replays = {{(1ULL << 62) + 3, "the tide"}, {(1ULL << 62) + 4, "no UTF-8: \xff"}};
  const auto again = read_node("a", write_node(with_replays));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->replays.at((1ULL << 62) + 3), "the tide");
  EXPECT_EQ(again->replays.size(), 2U);
  EXPECT_FALSE(read_node("a", R"({"node":"a","instance":"1","url":"","instruction_set":"",)"
                              R"("version":"","room":1,"accepts":true,"replays":[{}]})"));
  EXPECT_TRUE(read_node("a", R"({"node":"a","instance":"1","url":"","instruction_set":"",)"
                             R"("version":"","room":1,"accepts":true})"))
      << "of an earlier version";
  EXPECT_FALSE(read_node("a", "{}"));
  EXPECT_FALSE(read_node("b", write_node(make_node("a"))));
  EXPECT_FALSE(read_node("a", "no JSON"));
}

TEST(NodeTableTest, ANodeWithoutRenewalIsSilent) {
  ManualClock clock;
  NodeTable table(clock);
  table.note(make_node("a"), 1);
  clock.advance(milliseconds(1000));
  table.note(make_node("b"), 2);
  clock.advance(milliseconds(500));
  EXPECT_EQ(table.silence_of("a"), milliseconds(1500));
  EXPECT_EQ(table.silence_of("unknown"), milliseconds(1500)) << "since the start of this process";
  EXPECT_TRUE(table.is_seen_within("a", milliseconds(1501)));
  EXPECT_FALSE(table.is_seen_within("a", milliseconds(1500)));
  EXPECT_EQ(table.seen_within(milliseconds(1000)).size(), 1U);
  EXPECT_EQ(table.revision_of("b"), 2U);
  table.forget("b");
  EXPECT_FALSE(table.is_seen_within("b", milliseconds(10'000)));
}

TEST(NodeTableTest, TheEndOfANodeDoesNotChangeTheOrderOfTheOthers) {
  for (std::uint64_t session = 1; session <= 100; ++session) {
    auto all = rank_nodes(session, {"a", "b", "c"});
    ASSERT_THAT(all, UnorderedElementsAre("a", "b", "c"));
    EXPECT_EQ(rank_nodes(session, {"c", "b", "a"}), all);
    const std::vector<std::string> rest(all.begin() + 1, all.end());
    EXPECT_THAT(rank_nodes(session, rest), ElementsAre(all[1], all[2]));
  }
}

TEST(NodeTableTest, CountsTheNodesThatComeFirst) {
  ManualClock clock;
  NodeTable table(clock);
  table.note(make_node("silent"), 1);
  clock.advance(milliseconds(1000));
  NodeInfo full = make_node("full");
  full.accepts = false;
  table.note(full, 2);
  NodeInfo old = make_node("old");
  old.instruction_set = "sse";
  table.note(old, 3);
  for (const char* const name : {"a", "b", "c"}) table.note(make_node(name), 4);
  for (std::uint64_t session = 1; session <= 20; ++session) {
    const auto order = rank_nodes(session, {"a", "b", "c"});
    for (std::size_t place = 0; place < order.size(); ++place) {
      EXPECT_EQ(table.count_before(
                    order[place], session, milliseconds(1000),
                    [](const NodeInfo& node) { return node.instruction_set == "baseline"; }),
                place);
    }
  }
}

TEST(NodeTableTest, ANodeHasAllSmallerInstructionSets) {
  struct Case {
    const char* machine;
    const char* session;
    bool has;
  };
  for (const auto& [machine, session, has] :
       {Case{"avx512", "avx2", true}, Case{"avx2", "avx2", true}, Case{"baseline", "avx2", false},
        Case{"unknown", "baseline", false}, Case{"avx512", "unknown", false}}) {
    NodeInfo node = make_node("a");
    node.instruction_set = machine;
    EXPECT_EQ(has_instructions(node, session), has) << machine << ", " << session;
  }
}

TEST(NodeTableTest, SessionsAreSpreadOverTheNodes) {
  std::map<std::string, int> first;
  for (std::uint64_t session = 1; session <= 300; ++session) {
    ++first[rank_nodes(session, {"a", "b", "c"}).front()];
  }
  for (const auto& [name, count] : first) EXPECT_GT(count, 70) << name;
  EXPECT_EQ(first.size(), 3U);
}

}  // namespace
}  // namespace vat::test::node_table_test
