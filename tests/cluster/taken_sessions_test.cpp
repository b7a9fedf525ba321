// A node of a cluster whose sessions another node takes.

#include "server/cluster/cluster_node.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <future>

#include "tests/cluster/nats_servers.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace vat::test::taken_sessions_test {
namespace {

/// Host of the node's sessions. Lost sessions wait for run_end().
class HeldHost final : public ClusterHost {
 public:
  explicit HeldHost(Storage& storage) : storage_(storage) {}

  void start_taken(const StoredSession&) override { ++taken; }
  void end_lost(std::uint64_t session, const std::string&, std::function<void()> done) override {
    const std::lock_guard lock(mutex_);
    ends_.push_back([this, session, done = std::move(done)] {
      storage_.journal().post([this, session] { storage_.sessions().close(session); },
                              [this, done](auto) {
                                storage_.remove_closed();
                                done();
                              });
    });
    ++lost;
  }
  bool stop_for_move(std::uint64_t, std::function<void()> done) override {
    done();
    return true;
  }
  void create_for(const std::string&, std::function<void(const std::string&)> answer) override {
    answer("{}");
  }
  std::map<std::uint64_t, std::string> replays() const override { return {{9, "a replay"}}; }
  std::map<std::uint64_t, std::string> describe_sessions() const override { return described; }
  void cluster_changed() override { ++changes; }

  /// Removes a lost session from the storage.
  void run_end() {
    std::function<void()> end;
    {
      const std::lock_guard lock(mutex_);
      end = std::move(ends_.front());
      ends_.pop_front();
    }
    end();
  }

  std::map<std::uint64_t, std::string> described;
  std::atomic<int> taken = 0;
  std::atomic<int> lost = 0;
  std::atomic<int> changes = 0;

 private:
  Storage& storage_;
  std::mutex mutex_;
  std::deque<std::function<void()>> ends_;
};

class TakenSessionsTest : public testing::Test {
 protected:
  ~TakenSessionsTest() override {
    node.stop();
    storage.flush();
  }

  /// Creates a session on the node.
  std::uint64_t create() {
    StoredSession session;
    session.name = "lake";
    session.instruction_set = "baseline";
    session.settings = "{}";
    const LogEntry first{1, 0, 0, 0, "scene.load", "{}", false};
    session.number = node.add_session(session.name, session.instruction_set, "{}", first);
    storage.sessions().create(session, first);
    return session.number;
  }
  std::size_t stored_sessions() {
    storage.flush();
    return storage.sessions().sessions().size();
  }
  /// Waits until the node has looked at its sessions after all previous changes.
  void wait_for_looks() {
    const int before = host.changes;
    EXPECT_TRUE(wait_until([&] { return host.changes > before + 2; }));
  }
  /// Adds the entry of another node.
  void add_node(const NodeInfo& info) { nodes.create(info.name, write_node(info)); }
  ClusterSettings settings() const {
    ClusterSettings settings;
    settings.servers = servers.urls();
    settings.node = "a";
    settings.public_url = "ws://a/ws";
    settings.answer_time = std::chrono::minutes(5);  // longer than a test
    return settings;
  }

  NatsServers servers{1};
  TemporaryFolder folder;
  SystemClock clock;
  Storage storage{folder.path().string(), {}, clock};
  ClusterNode node{settings(), storage, clock, 2, "1.0"};
  HeldHost host{storage};
  NatsConnection connection{{servers.urls(), "test", {}, {}, {}, {}}};
  SessionLocator other{connection};
  Bucket nodes{connection, "vat-nodes", Lease::kOthersTime};
};

// The removal of the session from the data folder must not remove the session that the node has
// taken again.
TEST_F(TakenSessionsTest, ASessionIsTakenAgainAfterItsRemoval) {
  node.start(host);
  ASSERT_TRUE(wait_until([&] { return node.is_open(); }));
  const std::uint64_t session = create();
  LocatedSession there;
  const auto give_back = [&](int count) {
    ASSERT_TRUE(wait_until([&] { return host.lost == count; }));
    other.release(there, "a");
    ASSERT_TRUE(wait_until([&] { return node.find(session)->successor == "a"; }));
    wait_for_looks();
    EXPECT_EQ(host.taken, count - 1);
    host.run_end();
    ASSERT_TRUE(wait_until([&] { return host.taken == count; }));
    EXPECT_EQ(stored_sessions(), 1U);
    EXPECT_EQ(node.find(session)->owner, "a");
  };

  there = other.take(other.read(session).value(), "b");  // the node loses the session
  give_back(1);

  add_node({"b", "1", "ws://b/ws", "baseline", "1.0", 2, true});
  std::promise<std::optional<std::string>> moved;
  ASSERT_TRUE(wait_until(
      [&] { return !node.move(session, "b", [&](const auto& url) { moved.set_value(url); }); }));
  EXPECT_EQ(moved.get_future().get(), "ws://b/ws");
  there = other.take(other.read(session).value(), "b");
  give_back(2);
}

TEST_F(TakenSessionsTest, FindsReplaysOfOtherNodes) {
  node.start(host);
  EXPECT_FALSE(node.find(9)) << "a replay of this node";
  NodeInfo b{"b", "1", "ws://b/ws", "baseline", "1.0", 2, true};
  b.replays[7] = "the tide";
  add_node(b);
  ASSERT_TRUE(wait_until([&] { return node.find(7).has_value(); }));
  const LocatedSession replay = *node.find(7);
  EXPECT_EQ(replay.owner, "b");
  EXPECT_EQ(replay.name, "the tide");
  EXPECT_EQ(node.url_of(replay), "ws://b/ws");
  ASSERT_EQ(node.replays().size(), 1U);
  EXPECT_TRUE(node.sessions().empty());
  EXPECT_FALSE(node.find(8));
  const auto own = read_node("a", nodes.get("a")->value);
  ASSERT_TRUE(own);
  EXPECT_THAT(own->replays, testing::ElementsAre(testing::Pair(9, "a replay")));
}

// The entries of the other nodes do not list the replay yet.
TEST_F(TakenSessionsTest, AsksOtherNodesForTheirReplays) {
  node.start(host);
  std::atomic<int> refreshed = 0;
  const auto refresh = [&](int count) {
    const int before = refreshed;
    for (int i = 0; i < count; ++i) node.refresh_replays([&] { ++refreshed; });
    return [&, expected = before + count] {
      return wait_until([&] { return refreshed == expected; });
    };
  };
  EXPECT_TRUE(refresh(1)()) << "there is no other node";
  add_node({"c", "1", "ws://c/ws", "baseline", "1.0", 2, true});
  ASSERT_TRUE(wait_until([&] { return node.urls().size() == 2; }));
  EXPECT_TRUE(refresh(1)()) << "the node c has no connection";

  NodeInfo b{"b", "1", "ws://b/ws", "baseline", "1.0", 2, true};
  std::mutex mutex;
  std::vector<std::string> asked;  // subjects of the answers
  const auto questions =
      connection.subscribe(question_subject("b"), [&](const NatsMessage& question) {
        const std::lock_guard lock(mutex);
        asked.push_back(question.reply_to);
      });
  connection.flush(std::chrono::seconds(5));
  const auto answer_next = [&] {
    ASSERT_TRUE(wait_until([&] {
      const std::lock_guard lock(mutex);
      return !asked.empty();
    }));
    const std::lock_guard lock(mutex);
    connection.publish(asked.back(), write_node(b));
    asked.pop_back();
  };
  add_node(b);
  ASSERT_TRUE(wait_until([&] { return node.urls().size() == 3; }));
  const auto first = refresh(1);
  answer_next();
  EXPECT_TRUE(first());
  EXPECT_FALSE(node.find(7));
  b.replays[7] = "the tide";
  const auto others =
      refresh(3);  // the first one is asked at once, and the others share a question
  answer_next();
  answer_next();
  EXPECT_TRUE(others());
  ASSERT_TRUE(node.find(7));
  EXPECT_EQ(node.find(7)->owner, "b");
  const std::lock_guard lock(mutex);
  EXPECT_TRUE(asked.empty());
}

TEST_F(TakenSessionsTest, CollectsLongDescriptionsOfOtherNodes) {
  TemporaryFolder other_folder;
  Storage other_storage(other_folder.path().string(), {}, clock);
  ClusterSettings other_settings = settings();
  other_settings.node = "b";
  ClusterNode other_node(other_settings, other_storage, clock, 2, "1.0");
  HeldHost other_host(other_storage);
  for (std::uint64_t number = 1; number <= 9; ++number) {  // more than a message may have
    other_host.described[number] = std::string(200'000, static_cast<char>('0' + number));
  }
  host.described[10] = "of the asking node";
  node.start(host);
  other_node.start(other_host);
  ASSERT_TRUE(wait_until([&] { return node.urls().size() == 2; }));
  const auto collect = [&] {
    std::promise<ClusterNode::Descriptions> done;
    node.describe_sessions([&](const auto& all) { done.set_value(all); });
    return done.get_future().get();
  };
  EXPECT_TRUE(collect() == other_host.described);
  other_host.described.clear();
  EXPECT_TRUE(collect().empty());
  other_node.stop();
}

}  // namespace
}  // namespace vat::test::taken_sessions_test
