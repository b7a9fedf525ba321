#include "server/cluster/cluster_tokens.h"

#include <gtest/gtest.h>

#include <boost/asio/thread_pool.hpp>
#include <future>

#include "tests/cluster/nats_servers.h"
#include "tests/support/wait.h"

namespace vat::test::cluster_tokens_test {
namespace {

using Outcome = std::variant<bool, StorageError::Kind>;

class ClusterTokensTest : public testing::Test {
 protected:
  ~ClusterTokensTest() override {
    threads.join();
    connection.close();
  }

  TokenClaims claims_of(const std::string& session, double seconds = 60) const {
    return {TokenClaims::Kind::grant, Role::viewer, session,
            static_cast<std::uint64_t>(clock.wall_time() + seconds)};
  }
  static void add(ClusterTokens& node, const std::string& token, const TokenClaims& claims,
                  std::optional<std::size_t> uses) {
    std::promise<std::optional<StorageError::Kind>> done;
    node.add(hash_of_token(token), claims, uses, [&](auto failure) { done.set_value(failure); });
    EXPECT_EQ(done.get_future().get(), std::nullopt);
  }
  static std::future<Outcome> start_use(ClusterTokens& node, const std::string& token,
                                        const TokenClaims& claims) {
    const auto done = std::make_shared<std::promise<Outcome>>();
    node.use(hash_of_token(token), claims, [done](auto outcome) { done->set_value(outcome); });
    return done->get_future();
  }
  static Outcome use(ClusterTokens& node, const std::string& token, const TokenClaims& claims) {
    return start_use(node, token, claims).get();
  }
  std::vector<std::string> keys() {
    std::vector<std::string> keys;
    for (const auto& entry : bucket.all()) keys.push_back(entry.key);
    return keys;
  }

  NatsServers servers{1};
  NatsConnection connection{{servers.urls(), "test", {}, {}, {}, {}}};
  SystemClock clock;
  boost::asio::thread_pool threads{8};
  ClusterTokens a{connection, threads.get_executor(), clock, "a"};
  ClusterTokens b{connection, threads.get_executor(), clock, "b"};
  Bucket bucket{connection, "vat-tokens", std::chrono::hours(1)};
};

TEST_F(ClusterTokensTest, TwoNodesShareTheUses) {
  const TokenClaims claims = claims_of("s1");
  add(a, "token", claims, 2);
  EXPECT_EQ(use(b, "token", claims), Outcome(true));
  EXPECT_EQ(use(a, "token", claims), Outcome(true));
  EXPECT_EQ(use(a, "token", claims), Outcome(false));
  EXPECT_EQ(use(b, "token", claims), Outcome(false));
  EXPECT_EQ(use(b, "unknown", claims), Outcome(false));
  add(a, "unlimited", claims, {});
  for (int i = 0; i < 3; ++i) EXPECT_EQ(use(b, "unlimited", claims), Outcome(true));
}

TEST_F(ClusterTokensTest, ConcurrentUsesAreCounted) {
  const TokenClaims claims = claims_of("s1");
  add(a, "token", claims, 3);
  std::vector<std::future<Outcome>> uses;
  for (int i = 0; i < 4; ++i) {
    uses.push_back(start_use(a, "token", claims));
    uses.push_back(start_use(b, "token", claims));
  }
  int granted = 0;
  for (auto& one : uses) granted += one.get() == Outcome(true) ? 1 : 0;
  EXPECT_EQ(granted, 3);
}

TEST_F(ClusterTokensTest, TheTokensOfAnEndedSessionAreRemoved) {
  add(a, "first", claims_of("s1"), 1);
  add(a, "second", claims_of("s1"), {});
  add(a, "other", claims_of("s12"), 1);
  b.remove_session("s1");
  EXPECT_TRUE(wait_until([&] { return keys().size() == 1; }));
  EXPECT_EQ(keys().front().substr(0, 4), "s12.");
}

TEST_F(ClusterTokensTest, OldTokensAreRemoved) {
  add(a, "old", claims_of("s1", -600), 1);
  add(a, "new", claims_of("s1"), 1);
  ASSERT_EQ(keys().size(), 2U);
  // Each process begins with the last hour.
  ClusterTokens restarted(connection, threads.get_executor(), clock, "c");
  add(restarted, "next", claims_of(""), 1);
  EXPECT_EQ(keys().size(), 2U);
  EXPECT_EQ(use(restarted, "next", claims_of("")), Outcome(true));
}

TEST_F(ClusterTokensTest, TheBucketHasNoTokens) {
  add(a, "a secret text", claims_of("s1"), 1);
  for (const auto& entry : bucket.all()) {
    EXPECT_EQ((entry.key + entry.value).find("secret"), std::string::npos);
  }
}

TEST_F(ClusterTokensTest, WithoutServersAUseFails) {
  const TokenClaims claims = claims_of("s1");
  add(a, "token", claims, 1);
  servers.kill(0);
  ASSERT_TRUE(wait_until([&] { return !connection.is_connected(); }));
  EXPECT_EQ(use(a, "token", claims), Outcome(StorageError::Kind::unreachable));
}

}  // namespace
}  // namespace vat::test::cluster_tokens_test
