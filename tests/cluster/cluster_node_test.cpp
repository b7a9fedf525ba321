#include "server/cluster/cluster_node.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <mutex>
#include <string_view>

#include "tests/cluster/nats_servers.h"
#include "tests/support/manual_clock.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace vat::test::cluster_node_test {
namespace {

using std::chrono::milliseconds;

/// Counts the log's lines with a text during its lifetime.
class CountedLines {
 public:
  explicit CountedLines(std::string_view text) : before_(spdlog::default_logger()) {
    sink_->text = text;
    spdlog::set_default_logger(std::make_shared<spdlog::logger>("counted", sink_));
  }
  ~CountedLines() { spdlog::set_default_logger(before_); }
  CountedLines(const CountedLines&) = delete;
  CountedLines& operator=(const CountedLines&) = delete;

  int count() const { return sink_->count; }

 private:
  struct Sink final : spdlog::sinks::base_sink<std::mutex> {
    void sink_it_(const spdlog::details::log_msg& line) override {
      const std::string_view payload(line.payload.data(), line.payload.size());
      if (payload.find(text) != std::string_view::npos) ++count;
    }
    void flush_() override {}
    std::string_view text;
    std::atomic<int> count = 0;
  };

  const std::shared_ptr<spdlog::logger> before_;
  const std::shared_ptr<Sink> sink_ = std::make_shared<Sink>();
};

/// A host without sessions.
class EmptyHost final : public ClusterHost {
 public:
  void start_taken(const StoredSession&) override {}
  void end_lost(std::uint64_t, const std::string&, std::function<void()> done) override { done(); }
  bool stop_for_move(std::uint64_t, std::function<void()>) override { return false; }
  void create_for(const std::string&, std::function<void(const std::string&)>) override {}
  void cluster_changed() override {}
};

class ClusterNodeTest : public testing::Test {
 protected:
  ClusterNodeTest() {
    node.start(host);
    EXPECT_TRUE(wait_until([&] { return node.is_open(); }));
  }
  ~ClusterNodeTest() override {
    node.stop();
    connection.close();
  }
  ClusterSettings settings() const {
    ClusterSettings settings;
    settings.servers = servers.urls();
    settings.node = "a";
    settings.public_url = "ws://a/ws";
    settings.entry_life = std::chrono::minutes(10);  // NATS does not use the test's clock
    return settings;
  }

  void remove_stream(const std::string& name) {
    connection.request("$JS.API.STREAM.DELETE." + name, "", milliseconds(5000));
  }
  /// Expects that the next renewal fails, and that another one follows before the interval ends.
  void expect_repeated_renewal() {
    std::atomic<int> renewals = 0;
    const auto subscription =
        connection.subscribe("$KV.vat-nodes.a", [&](const NatsMessage&) { ++renewals; });
    connection.flush(milliseconds(5000));
    const CountedLines failures("the lease is not renewed");
    clock.advance(Lease::kLeastRenewal);
    ASSERT_TRUE(wait_until([&] { return failures.count() == 1 && renewals == 1; }));
    clock.advance(Lease::kLeastRenewal / 5);
    EXPECT_TRUE(wait_until([&] { return renewals == 2; }));
  }

  ManualClock clock;
  NatsServers servers{1};
  NatsConnection connection{{servers.urls(), "test", {}, {}, {}, {}}};
  TemporaryFolder folder;
  Storage storage{folder.path(), {}, clock};
  EmptyHost host;
  ClusterNode node{settings(), storage, clock, 2, "test"};
};

TEST_F(ClusterNodeTest, RepeatsARenewalSoonAfterAConflict) {
  Bucket bucket(connection, "vat-nodes", std::chrono::minutes(10));
  const auto entry = bucket.get("a");
  ASSERT_TRUE(entry);
  bucket.put("a", entry->value, entry->revision);
  expect_repeated_renewal();
}

TEST_F(ClusterNodeTest, RepeatsARenewalSoonAfterAFailure) {
  remove_stream("KV_vat-nodes");
  remove_stream("KV_vat-spare-nodes");
  expect_repeated_renewal();
}

TEST_F(ClusterNodeTest, RenewsInTheSpareBucketIfTheOtherDoesNotAnswer) {
  remove_stream("KV_vat-nodes");
  std::atomic<int> renewals = 0;
  const auto subscription =
      connection.subscribe("$KV.vat-spare-nodes.a", [&](const NatsMessage&) { ++renewals; });
  connection.flush(milliseconds(5000));
  const int count = static_cast<int>(2 * Lease::kOthersTime / Lease::kLeastRenewal);
  for (int i = 1; i <= count; ++i) {
    clock.advance(Lease::kLeastRenewal);
    ASSERT_TRUE(wait_until([&] { return renewals == i; }));
    // The node is in its own list of nodes by the renewals that it receives.
    ASSERT_TRUE(wait_until([&] { return node.is_open() && !node.urls().empty(); }));
  }
}

}  // namespace
}  // namespace vat::test::cluster_node_test
