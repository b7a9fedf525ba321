// A session's step runs on its own thread first. Free threads then help other sessions.

#include "core/threads/thread_pool.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::session_threads_test {
namespace {

constexpr int kTicks = 10;
constexpr int kMostRounds = 100;  // of kTicks each; one is enough on free processors
constexpr double kHelp = 1e6;     // processor time of helpers [ns]

/// A scene of some thousand particles, so that waking a helper is worthwhile.
Scene pool_scene() {
  return to_scene(R"({
    "format": "vat.scene/1", "name": "pool", "title": "Pool",
    "materials": [{"name": "water", "density": 1000,
                   "liquid": {"stiffness": 50, "viscosity": 1, "support_radius": 0.1}}],
    "vat": {"min": [0, 0, 0], "max": [1, 1, 1], "lid": true},
    "numerics": {"integrator": "velocity_verlet", "step": 0.002, "tick": 0.02},
    "bodies": [{"name": "pool", "kind": "liquid", "material": "water", "spacing": 0.05,
                "shape": {"type": "box", "center": [0.4, 0.5, 0.3], "size": [0.7, 0.9, 0.5]}}]})");
}

ServerSettings with_threads(std::size_t threads) {
  ServerSettings settings;
  settings.threads = threads;
  return settings;
}

/// Returns the processor time of the helper threads [ns].
double helper_time() {
  double total = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::string name;
    std::getline(std::ifstream(task.path() / "comm"), name);
    double time = 0;
    if (name == ThreadPoolRunner::kThreadName) std::ifstream(task.path() / "schedstat") >> time;
    total += time;
  }
  return total;
}

class SessionThreads : public testing::Test {
 protected:
  /// Starts a paused session at tick 0 with one client.
  std::unique_ptr<TestClient> start(TestServer& server) {
    const SessionId id = server.create_session("pool", pool_scene()).value();
    auto client = std::make_unique<TestClient>(server, ++last_connection_);
    client->result("session.join", {{"session", id}});
    client->result("control.pause");
    client->result("control.reset");
    return client;
  }
  static std::string expected_hash(int ticks = kTicks) {
    Simulation alone = Simulation::create(pool_scene()).value();
    advance_ticks(alone, static_cast<std::uint64_t>(ticks));
    return hash_of(alone);
  }

  const Catalogue catalogue = Catalogue::open(TemporaryFolder().path().string()).value();

 private:
  ConnectionId last_connection_ = 0;
};

TEST_F(SessionThreads, ALoneSessionIsHelped) {
  TestServer server(catalogue, with_threads(4));
  const auto client = start(server);
  const double helped = helper_time() + kHelp;
  int rounds = 0;
  // While all processors are busy, a helper can wake too late for a step.
  for (; rounds < kMostRounds && helper_time() < helped; ++rounds) {
    client->result("control.step", {{"ticks", kTicks}});
  }
  EXPECT_GE(helper_time(), helped);
  EXPECT_EQ(client->result("session.hash").at("hash"), expected_hash(rounds * kTicks));
}

TEST_F(SessionThreads, OneThreadHasNoHelpers) {
  TestServer server(catalogue, with_threads(1));
  const auto client = start(server);
  client->result("control.step", {{"ticks", 1}});
  EXPECT_EQ(helper_time(), 0);
}

TEST_F(SessionThreads, SessionsAtOnceHaveTheBitsOfEachAlone) {
  TestServer server(catalogue, with_threads(4));
  std::vector<std::unique_ptr<TestClient>> clients;
  std::vector<int> steps;
  for (int i = 0; i < 3; ++i) clients.push_back(start(server));
  for (const auto& client : clients) {
    steps.push_back(client->send("control.step", {{"ticks", kTicks}}));
  }
  const std::string expected = expected_hash();
  for (std::size_t i = 0; i < clients.size(); ++i) {
    clients[i]->wait_reply(steps[i]);
    EXPECT_EQ(clients[i]->result("session.hash").at("hash"), expected);
  }
}

}  // namespace
}  // namespace vat::test::session_threads_test
