#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "tests/server/session_fixture.h"

namespace vat::test {

/// A server on a data folder, or on none where that is empty, and a client in its session s1, which
/// is paused at tick 0.
class Host {
 public:
  Host(const Catalogue& catalogue, const std::string& folder, const ServerLimits& limits)
      : server(catalogue, test_settings(limits, folder)) {
    begin();
  }
  /// On a clock that outlives the server.
  Host(const Catalogue& catalogue, const std::string& folder, const ServerLimits& limits,
       ManualClock& clock)
      : server(catalogue, test_settings(limits, folder), clock) {
    begin();
  }
  std::string hash() { return client->result("session.hash").at("hash"); }
  std::uint64_t tick() { return client->result("session.hash").at("tick"); }
  void step(int ticks) { client->result("control.step", {{"ticks", ticks}}); }

 private:
  void begin() {
    if (server.recover() == 0 && !server.create_session("first", to_scene(mixed_scene_text()))) {
      throw std::runtime_error("the first session was refused");
    }
    client.emplace(server, 1);
    client->result("session.join", {{"session", "s1"}, {"name", "Ada"}});
    client->result("control.pause");
  }

 public:
  TestServer server;
  std::optional<TestClient> client;
};

}  // namespace vat::test
