#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "server/rpc/session_server.h"
#include "tests/server/fake_connection.h"
#include "tests/support/manual_clock.h"

namespace vat::test {

/// A scene of about a hundred particles with a vat: the liquid `pool` (body 1), the deformable
/// `cube` (2) and the rigid `ball` (3). Ten steps a tick of 0.02 s.
const std::string& mixed_scene_text();
/// Two particles on a spring so stiff that no step of the guard holds it.
const std::string& unstable_scene_text();
/// Has `mixed` and `unstable`.
Catalogue make_catalogue();
Scene to_scene(const std::string& text);

inline constexpr std::string_view kAdminToken = "the admin token of the tests";

/// Clients may send as fast as they like.
ServerLimits unhurried_limits();
/// The default limits, except for one.
template <class Value>
ServerLimits limits_with(Value ServerLimits::*limit, std::type_identity_t<Value> value) {
  ServerLimits limits;
  limits.*limit = value;
  return limits;
}
/// Two threads, and no delay where a token is refused. `data_folder`: empty for none.
ServerSettings test_settings(const ServerLimits& limits, const std::string& data_folder = "");

/// Base class, so that the clock outlives the server.
struct OwnClock {
  ManualClock own_clock;
};

/// A SessionServer on a clock that the test controls.
class TestServer : private OwnClock, public SessionServer {
 public:
  TestServer(const Catalogue& catalogue, ServerSettings settings);
  /// On a clock that outlives the server.
  TestServer(const Catalogue& catalogue, ServerSettings settings, ManualClock& clock);

  ManualClock& clock() { return *clock_; }
  /// Advances the clock to the next timers until `condition` is true.
  void advance_until(const std::function<bool()>& condition);

 private:
  ManualClock* clock_;
};

/// One client of a TestServer, which must outlive it.
class TestClient {
 public:
  TestClient(TestServer& server, ConnectionId id, std::string address = "127.0.0.1");
  ~TestClient() { disconnect(); }
  TestClient(const TestClient&) = delete;
  TestClient& operator=(const TestClient&) = delete;

  void disconnect();

  /// Sends a request; its id.
  int send(std::string_view method, const Json& params = nullptr);
  void notify(std::string_view method, const Json& params = nullptr);
  /// The same of what is to be refused, as nobody is told.
  void notify_wrong(std::string_view method, const Json& params = nullptr);
  void send_raw(std::string_view text, bool wrong = false);

  /// The reply to a request that was sent.
  Json wait_reply(const Json& id);
  /// The reply to a command that a playing session carries out with its next tick. Advances the
  /// clock to it.
  Json wait_reply_at_tick(int id);
  /// Sends and waits: the whole reply, its `result`, or its `error`. The last two fail the test,
  /// and return null, where the reply is of the other sort.
  Json call(std::string_view method, const Json& params = nullptr);
  Json result(std::string_view method, const Json& params = nullptr);
  Json error(std::string_view method, const Json& params = nullptr);

  /// Holds a body at its first particle; the grab's id.
  std::uint64_t grab(BodyId body);

  /// The params of the first event since mark() that fits. Advances the clock until it comes.
  Json wait_event(std::string_view event, const std::function<bool(const Json&)>& fits = {});
  /// The first frame that fits. Advances the clock until it comes; acknowledges all frames until
  /// then.
  GridFrame wait_frame(const std::function<bool(const GridFrame&)>& fits);
  /// Advances the clock until the server closes the connection.
  void wait_closed();
  /// The params of all events since mark().
  std::vector<Json> events(std::string_view event) const;
  /// Events before this are not looked at again.
  void mark() { mark_ = connection->texts().size(); }

  const std::shared_ptr<FakeConnection> connection;

 private:
  TestServer& server_;
  int last_id_ = 0;
  std::size_t mark_ = 0;
  std::size_t seen_frames_ = 0;
  bool connected_ = true;
};

/// A server with one session of mixed_scene_text() (`s1`), paused at tick 0, and one client in it.
class SessionTest : public testing::Test {
 protected:
  /// Clients may send as fast as they like, unless the test has limits of its own.
  explicit SessionTest(const ServerLimits& limits = unhurried_limits());

  /// Connects a further client.
  std::unique_ptr<TestClient> connect();
  /// Connects one that was let in as an admin.
  std::unique_ptr<TestClient> connect_admin();
  std::unique_ptr<TestClient> connect_from(std::string address);
  /// Connects one that has joined `session`.
  std::unique_ptr<TestClient> join(const std::string& session = "s1");
  std::string hash() { return client->result("session.hash").at("hash"); }
  std::uint64_t tick() { return client->result("session.hash").at("tick"); }

  const Catalogue catalogue;
  TestServer server;
  std::unique_ptr<TestClient> client;

 private:
  ConnectionId last_connection_ = 0;
};

/// Steps a simulation by ticks, as a session does.
void advance_ticks(Simulation& simulation, std::uint64_t ticks);
/// The beginning of a zstd frame that says how many bytes it holds, and holds none.
std::vector<std::uint8_t> bytes_that_say(std::uint32_t size);
/// As in a reply to session.hash.
std::string hash_of(const Simulation& simulation);

}  // namespace vat::test
