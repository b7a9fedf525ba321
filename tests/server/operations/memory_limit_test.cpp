// The memory of the process, and the rejection of new work beyond its limit.

#include "server/operations/memory_limit.h"

#include "tests/server/fixture/host.h"

namespace vat::test::memory_limit_test {
namespace {

TEST(ProcessMemory, GrowsByThePagesThatAreUsed) {
  constexpr std::size_t kBytes = std::size_t{64} << 20;
  const std::size_t before = process_memory();
  EXPECT_GT(before, 1'000'000U);
  const std::vector<char> used(kBytes, 'x');
  EXPECT_GE(process_memory(), before + kBytes * 9 / 10) << used.size();
}

TEST(MemoryLimit, HoldsAtItsValueAndNotBeyond) {
  std::size_t used = 1000;
  const auto measure = [&used] { return used; };
  EXPECT_FALSE(MemoryLimit(1000, measure).find_excess());
  EXPECT_FALSE(MemoryLimit(0, measure).find_excess()) << "no limit";
  ++used;
  const auto excess = MemoryLimit(1000, measure).find_excess();
  ASSERT_TRUE(excess);
  EXPECT_EQ(excess->limit, "memory_bytes");
  EXPECT_EQ(excess->maximum, 1000U);
}

class LimitedMemory : public testing::Test {
 protected:
  static constexpr std::size_t kMaximum = 1000;
  ServerSettings settings() {
    ServerLimits limits = unhurried_limits();
    limits.max_memory = kMaximum;
    ServerSettings settings = test_settings(limits);
    settings.measure_memory = [this] { return free_checks-- > 0 ? 0 : used.load(); };
    return settings;
  }
  void expect_refused(const char* method, const Json& params) {
    const Json error = client.error(method, params);
    EXPECT_EQ(error.at("code"), 1005) << method;
    EXPECT_EQ(error.at("data").at("limit"), "memory_bytes") << method;
    EXPECT_EQ(error.at("data").at("maximum"), kMaximum) << method;
  }

  std::atomic<std::size_t> used{0};
  std::atomic<int> free_checks{0};  // next measurements that return 0
  const Catalogue catalogue = make_catalogue();
  ManualClock clock;
  Host host{catalogue, settings(), clock};
  TestClient& client = *host.client;
};

TEST_F(LimitedMemory, RefusesNewWorkAndNothingElse) {
  const std::string hash = host.hash();
  used = kMaximum + 1;
  const Json scene_name{{"scene", "mixed"}};
  expect_refused("session.create", {{"name", "n"}, {"scene", "mixed"}});
  expect_refused("scene.load", scene_name);
  expect_refused("world.add_body", {{"body", Json::object()}});
  expect_refused("session.save", {{"name", "n"}});
  expect_refused("state.query", Json::object());
  EXPECT_EQ(host.hash(), hash);
  client.result("control.step");
  client.result("session.list");
  TestClient other(host.server, 2);
  other.result("session.join");
  used = kMaximum;
  client.result("scene.load", scene_name);
  const std::string created = client.create_session();
  used = kMaximum + 1;
  client.result("session.close", {{"session", created}});
}

// The memory of a scene is known only when its simulation exists.
TEST_F(LimitedMemory, RefusesASceneThatIsTooLarge) {
  const std::string hash = host.hash();
  used = kMaximum + 1;
  for (const auto& [method, params] :
       {std::pair<const char*, Json>("scene.load", {{"scene", "unstable"}}),
        std::pair<const char*, Json>("session.create", {{"name", "n"}, {"scene", "unstable"}})}) {
    free_checks = 1;  // the check before the work
    expect_refused(method, params);
    EXPECT_EQ(free_checks, -1) << "a second check";
  }
  EXPECT_EQ(host.hash(), hash);
}

}  // namespace
}  // namespace vat::test::memory_limit_test
