#pragma once

#include <memory>
#include <string>

#include "server/access/token.h"
#include "tests/server/session_fixture.h"

namespace vat::test {

/// A server that lets in who shows a token, with one session of mixed_scene_text() (`s1`), which
/// has no owner.
class AccessTest : public testing::Test {
 protected:
  explicit AccessTest(std::chrono::milliseconds refusal_delay = {})
      : catalogue(make_catalogue()), server(catalogue, token_settings(refusal_delay)) {
    if (!server.create_session("first", to_scene(mixed_scene_text()))) {
      throw std::runtime_error("the first session was refused");
    }
    admin = enter(std::string(kAdminToken));
  }

  static ServerSettings token_settings(std::chrono::milliseconds refusal_delay = {}) {
    ServerSettings settings = test_settings(unhurried_limits());
    settings.access.mode = AccessMode::token;
    settings.access.refusal_delay = refusal_delay;
    return settings;
  }

  std::unique_ptr<TestClient> connect() { return std::make_unique<TestClient>(server, ++last_); }
  std::unique_ptr<TestClient> enter(const std::string& token) {
    auto client = connect();
    client->result("access.enter", {{"token", token}});
    return client;
  }
  std::string ticket(const Json& params) {
    return admin->result("access.ticket", params).at("token");
  }
  /// Who has made a session of its own and joined it; its id is in `own`.
  std::unique_ptr<TestClient> owner() {
    auto client = enter(ticket({{"role", "controller"}}));
    own = client->result("session.create", {{"name", "own"}, {"scene", "mixed"}}).at("session");
    client->result("session.join", {{"session", own}});
    return client;
  }
  /// Who has joined by an invitation; what the join told it is in `joined`.
  std::unique_ptr<TestClient> invited(TestClient& owner, const std::string& role) {
    const Json invitation = owner.result("session.invite", {{"role", role}});
    auto client = enter(invitation.at("token"));
    joined = client->result("session.join");
    return client;
  }
  static std::string role_of(TestClient& client) {
    const Json error = client.call("session.invite", {{"role", "viewer"}});
    return error.contains("error") ? error.at("error").at("data").at("role") : Json("owner");
  }

  const Catalogue catalogue;
  TestServer server;
  std::unique_ptr<TestClient> admin;
  std::string own;
  Json joined;

 private:
  ConnectionId last_ = 0;
};

}  // namespace vat::test
