// Frames of a replay at a node that does not have the replay.

#include <gtest/gtest.h>

#include "tests/cluster/nodes.h"
#include "tests/cluster/received_frames.h"
#include "tests/support/wait.h"

namespace vat::test::relayed_replay_test {
namespace {

constexpr const char* kSession = "s1";
constexpr std::uint64_t kTicks = 12;

/// Opens a replay of the session at the connection's node, and joins it. Returns its range.
client::ReplayOpen::Result open_replay(client::Client& viewer) {
  client::SessionJoin::Params join;
  join.session = kSession;
  viewer.call<client::SessionJoin>(join).get();
  viewer.call<client::ControlPause>({}).get();
  client::ControlStep::Params step;
  step.ticks = kTicks;
  viewer.call<client::ControlStep>(step).get();
  client::ReplayOpen::Params open;
  open.session = kSession;
  auto opened = viewer.call<client::ReplayOpen>(open).get();
  join.session = opened.session;
  viewer.call<client::SessionJoin>(join).get();
  viewer.call<client::ControlPause>({}).get();
  return opened;
}

TEST(RelayedReplay, HasTheFramesOfTheOwnerAfterEachSeek) {
  Nodes nodes(2, {"--route", "relay"});
  const std::string owner = nodes.owner_of(kSession, "a");
  Received direct;
  Received relayed;
  client::Client at_owner(nodes.url(owner), {}, direct.handlers());
  client::Client at_relay(nodes.url(nodes.others(owner).front()), {}, relayed.handlers());
  const auto replay = open_replay(at_relay);
  ASSERT_GE(replay.end, replay.begin + kTicks);
  client::SessionJoin::Params join;
  join.session = replay.session;
  EXPECT_EQ(at_owner.call<client::SessionJoin>(join).get().session, replay.session);
  client::FramesSubscribe::Params wish;
  wish.max_error = 1e-3;
  at_owner.call<client::FramesSubscribe>(wish).get();
  at_relay.call<client::FramesSubscribe>(wish).get();

  std::vector<std::map<std::string, std::vector<Vec3>>> seen;
  for (const std::uint64_t position : {replay.end, replay.begin, replay.begin + kTicks / 2}) {
    client::ReplaySeek::Params seek;
    seek.position = position;
    const auto sought = at_relay.call<client::ReplaySeek>(seek).get();
    EXPECT_EQ(sought.position, position);
    ASSERT_TRUE(wait_until([&] {
      const std::scoped_lock lock(direct.mutex, relayed.mutex);
      return direct.tick == sought.tick && relayed.tick == sought.tick &&
             !direct.positions.empty() && !relayed.positions.empty();
    })) << position;
    const std::scoped_lock lock(direct.mutex, relayed.mutex);
    expect_same_positions(direct, relayed);
    seen.push_back(relayed.positions);
  }
  EXPECT_NE(seen[0], seen[1]) << "positions at the end and at the begin";
  EXPECT_NE(seen[1], seen[2]);
}

}  // namespace
}  // namespace vat::test::relayed_replay_test
