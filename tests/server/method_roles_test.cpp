// OWASP WebSocket: "authorise every message": every method by every role.

#include <map>

#include "server/session/method_table.h"
#include "tests/server/session_fixture.h"

namespace vat::test::method_roles_test {
namespace {

/// Params that are read without an error, of every method that needs some.
const std::map<std::string_view, Json>& good_params() {
  static const Json kTarget = {0, 0, 0};
  static const Json kOther = {{"participant", 1}};
  static const std::map<std::string_view, Json> kParams = {
      {"session.create", {{"name", "n"}, {"scene", "mixed"}}},
      {"session.close", {{"session", "SESSION"}}},
      {"scene.load", {{"scene", "mixed"}}},
      {"control.set_speed", {{"speed", 1}}},
      {"world.add_body", {{"body", Json::object()}}},
      {"world.remove_body", {{"body", 99}}},
      {"world.melt_body", {{"body", 99}, {"material", "water"}}},
      {"world.set_emitter", {{"emitter", "tap"}, {"open", true}}},
      {"world.set_gravity", {{"gravity", kTarget}}},
      {"world.set_interface", {{"interface", Json::object()}}},
      {"world.apply_force", {{"body", 99}, {"force", kTarget}, {"duration", 1}}},
      {"world.move_body", {{"body", 99}, {"position", kTarget}}},
      {"world.set_material", {{"material", Json::object()}}},
      {"world.set_numerics", {{"integrator", "heun"}}},
      {"world.move_vat", {{"offset", kTarget}}},
      {"grab.start", {{"body", 99}, {"particle", 0}, {"target", kTarget}}},
      {"grab.move", {{"grab", 99}, {"target", kTarget}}},
      {"grab.end", {{"grab", 99}}},
      {"frames.ack", {{"number", 1}}},
      {"session.invite", {{"role", "viewer"}}},
      {"participant.rename", {{"name", "x"}}},
      {"participant.set_role", {{"participant", 99}, {"role", "viewer"}}},
      {"participant.kick", {{"participant", 99}}},
      {"control.hand_over", {{"participant", 99}}},
      {"access.enter", {{"token", kAdminToken}}},
      {"session.save", {{"name", "n"}}},
      {"session.load", {{"name", "n"}}},
      {"session.delete_save", {{"name", "n"}}},
      {"scene.save", {{"name", "n"}}},
      {"scene.delete", {{"name", "n"}}},
      {"access.ticket", {{"role", "viewer"}, {"session", "SESSION"}}},
      {"recording.import", {{"size", 9}, {"offset", 0}, {"data", "AAAA"}}},
      {"replay.open", {{"session", "SESSION"}}},
      {"replay.seek", {{"tick", 1}}},
  };
  return kParams;
}

constexpr Role kRoles[] = {Role::none, Role::viewer, Role::controller, Role::owner, Role::admin};

class MethodRoles : public testing::Test {
 protected:
  MethodRoles() : catalogue(make_catalogue()), server(catalogue, settings()) {}

  static ServerSettings settings() {
    ServerSettings settings;
    settings.threads = 2;
    settings.access.mode = AccessMode::token;
    settings.access.admin = hash_of_token(kAdminToken);
    return settings;
  }
  std::unique_ptr<TestClient> enter(const std::string& token) {
    auto client = std::make_unique<TestClient>(server, ++last_);
    client->result("access.enter", {{"token", token}});
    return client;
  }

  /// One who has this role in a session of its own, and that session.
  struct Cast {
    std::unique_ptr<TestClient> owner, subject;
    std::string session;
  };
  Cast cast(Role role) {
    Cast cast;
    const auto admin = enter(std::string(kAdminToken));
    cast.owner = enter(ticket(*admin, Role::controller));
    const Json created = cast.owner->result("session.create", {{"name", "n"}, {"scene", "mixed"}});
    cast.session = created.at("session");
    const Json joined = cast.owner->result("session.join", {{"session", cast.session}});
    EXPECT_EQ(joined.at("role"), "owner");
    if (role == Role::owner) {
      cast.subject = std::move(cast.owner);
    } else if (role == Role::none) {
      cast.subject = std::make_unique<TestClient>(server, ++last_);
    } else {
      cast.subject = enter(role == Role::admin ? std::string(kAdminToken) : ticket(*admin, role));
      const Json here = cast.subject->result("session.join", {{"session", cast.session}});
      EXPECT_EQ(here.at("role"), to_string(role));
    }
    return cast;
  }
  static std::string ticket(TestClient& admin, Role role) {
    return admin.result("access.ticket", {{"role", to_string(role)}}).at("token");
  }
  void close(const std::string& session) {
    enter(std::string(kAdminToken))->call("session.close", {{"session", session}});
  }

  struct Closer {
    MethodRoles& test;
    std::string session;
    ~Closer() { test.close(session); }
  };

  const Catalogue catalogue;
  SessionServer server;

 private:
  ConnectionId last_ = 0;
};

Json params_of(std::string_view method, const std::string& session) {
  const auto found = good_params().find(method);
  if (found == good_params().end()) return nullptr;
  Json params = found->second;
  if (params.value("session", "") == "SESSION") params["session"] = session;
  return params;
}

/// For a method of the server it is that which one was let in with: an owner is a controller there.
Role counting_role(const Method& method, Role role) {
  const bool is_of_server =
      std::holds_alternative<Method::ForServer>(method.read) && !method.rules.is_of_named_session;
  return is_of_server && role == Role::owner ? Role::controller : role;
}

TEST_F(MethodRoles, EveryMethodByEveryRole) {
  for (const Role role : kRoles) {
    for (const Method& method : all_methods()) {
      SCOPED_TRACE(std::string(method.name) + " by " + to_string(role));
      const Cast cast = this->cast(role);
      const Closer closer{*this, cast.session};
      const Json reply = cast.subject->call(method.name, params_of(method.name, cast.session));
      const Json error = reply.value("error", Json::object());
      const int code = error.value("code", 0);
      const Role least = method.rules.least_role;
      const bool is_refused = error.contains("data") && error["data"].contains("least_role");
      if (role == Role::none && least > Role::none) {
        EXPECT_EQ(code, 1007) << reply;
        continue;
      }
      EXPECT_NE(code, 1007) << reply;
      EXPECT_EQ(is_refused, counting_role(method, role) < least)
          << reply << " (does good_params() have the method's?)";
      if (!is_refused) continue;
      EXPECT_EQ(code, 1006);
      EXPECT_EQ(error.at("data").at("role"), to_string(counting_role(method, role)));
      EXPECT_EQ(error.at("data").at("least_role"), to_string(least));
    }
  }
}

}  // namespace
}  // namespace vat::test::method_roles_test
