// The C++ client in a cluster.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <iostream>

#include "protocol/client/client.h"
#include "tests/cluster/nodes.h"
#include "tests/support/wait.h"

namespace vat::test::cluster_client_test {
namespace {

using namespace client;

TEST(ClusterClient, FollowsItsSessionWhenItsNodeFails) {
  Nodes nodes(2);
  const std::string first = nodes.owner_of("s1", "a");
  const std::string second = nodes.others(first).front();
  std::atomic<int> frames = 0;
  std::atomic<int> resumed = 0;
  Handlers handlers;
  handlers.on_frame = [&](const Frame&) { ++frames; };
  handlers.on_rejoined = [&](const SessionJoin::Result& joined) { resumed += joined.resumed; };
  Client client(nodes.url(second), {}, handlers);  // the node without the session
  SessionJoin::Params join;
  join.session = "s1";
  const auto joined = client.call<SessionJoin>(join).get();
  EXPECT_EQ(joined.session, "s1");
  client.call<FramesSubscribe>({}).get();
  ASSERT_TRUE(wait_until([&] { return frames > 0; }));

  const auto begin = std::chrono::steady_clock::now();
  nodes.process(first).kill();
  ASSERT_TRUE(wait_until([&] { return resumed == 1; }));
  frames = 0;
  ASSERT_TRUE(wait_until([&] { return frames > 0; }));
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  std::cout << time.count() << " s from the kill to the first frame\n";
  EXPECT_EQ(client.call<SessionJoin>(join).get().session, "s1");  // at the node that it has found
}

}  // namespace
}  // namespace vat::test::cluster_client_test
