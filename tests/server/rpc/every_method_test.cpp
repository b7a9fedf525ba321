// Rules for every method of the protocol: roles, sessions and checks of parameters.

#include <gmock/gmock.h>

#include "server/rpc/method_table.h"
#include "tests/server/fixture/access_fixture.h"

namespace vat::test::every_method_test {
namespace {

/// Returns all parameters of every method that has some, with values that are read without an
/// error.
const std::map<std::string_view, Json>& all_params() {
  static const Json kTarget = {0, 0, 0};
  static const std::map<std::string_view, Json> kParams = {
      {"session.create", {{"name", "n"}, {"scene", "mixed"}}},
      {"session.join",
       {{"session", "SESSION"}, {"name", "n"}, {"resume", "x"}, {"role", "controller"}}},
      {"session.close", {{"session", "SESSION"}}},
      {"session.configure", {{"name", "n"}, {"default_role", "viewer"}, {"locked", false}}},
      {"session.stats", {{"diagnostics", false}}},
      {"scene.get", {{"current", true}}},
      {"scene.load", {{"scene", "mixed"}}},
      {"control.step", {{"ticks", 1}}},
      {"control.set_speed", {{"speed", 1}}},
      {"world.add_body", {{"body", Json::object()}}},
      {"world.remove_body", {{"body", 99}}},
      {"world.melt_body", {{"body", 99}, {"material", "water"}}},
      {"world.set_emitter", {{"emitter", "tap"}, {"open", true}}},
      {"world.set_gravity", {{"gravity", kTarget}}},
      {"world.set_interface", {{"interface", Json::object()}}},
      {"world.apply_force", {{"body", 99}, {"force", kTarget}, {"duration", 1}}},
      {"world.move_body",
       {{"body", 99}, {"position", kTarget}, {"orientation", {1, 0, 0, 0}}, {"velocity", kTarget}}},
      {"world.set_material", {{"material", Json::object()}}},
      {"world.set_numerics", {{"integrator", "heun"}, {"step", 0.001}}},
      {"world.move_vat", {{"offset", kTarget}}},
      {"grab.start", {{"body", 99}, {"particle", 0}, {"target", kTarget}}},
      {"grab.move", {{"grab", 99}, {"target", kTarget}}},
      {"grab.end", {{"grab", 99}}},
      {"frames.subscribe",
       {{"every", 1},
        {"max_error", 0},
        {"detail", 3},
        {"region", {{"min", kTarget}, {"max", {1, 1, 1}}}},
        {"attributes", {{"speed", 1}}}}},
      {"frames.ack", {{"number", 1}, {"rejected", true}}},
      {"state.query", {{"bodies", {1}}}},
      {"state.connections", {{"body", 1}, {"most", 1}}},
      {"session.invite", {{"role", "viewer"}, {"uses", 1}, {"expires", 60}}},
      {"participant.rename", {{"name", "x"}}},
      {"participant.set_role", {{"participant", 99}, {"role", "viewer"}}},
      {"participant.kick", {{"participant", 99}, {"reason", "x"}}},
      {"control.hand_over", {{"participant", 99}}},
      {"presence.point", {{"position", kTarget}, {"direction", {0, 0, 1}}}},
      {"access.enter", {{"token", kAdminToken}}},
      {"access.ticket", {{"role", "viewer"}, {"session", "SESSION"}}},
      {"session.save", {{"name", "n"}}},
      {"session.load", {{"name", "n"}}},
      {"session.delete_save", {{"name", "n"}}},
      {"scene.save", {{"name", "n"}}},
      {"scene.delete", {{"name", "n"}}},
      {"recording.import", {{"size", 9}, {"offset", 0}, {"data", "AAAA"}}},
      {"replay.open", {{"session", "SESSION"}}},
      {"replay.seek", {{"tick", 1}}},
      {"server.drain", {{"seconds", 1}}},
  };
  return kParams;
}

constexpr Role kRoles[] = {Role::none, Role::viewer, Role::controller, Role::owner, Role::admin};

class EveryMethod : public AccessTest {
 protected:
  /// A client with a given role in its own session, and that session.
  struct Cast {
    std::unique_ptr<TestClient> owner, subject;
    std::string session;
  };
  Cast cast(Role role) {
    Cast cast;
    cast.owner = enter(ticket({{"role", "controller"}}));
    cast.session = cast.owner->create_session();
    joined = cast.owner->result("session.join", {{"session", cast.session}});
    EXPECT_EQ(joined.at("role"), "owner");
    if (role == Role::owner) {
      cast.subject = std::move(cast.owner);
    } else if (role == Role::none) {
      cast.subject = connect();
    } else {
      cast.subject = enter(role == Role::admin ? std::string(kAdminToken)
                                               : ticket({{"role", to_string(role)}}));
      joined = cast.subject->result("session.join", {{"session", cast.session}});
      EXPECT_EQ(joined.at("role"), to_string(role));
    }
    return cast;
  }
  struct Closer {
    TestClient& admin;
    std::string session;
    ~Closer() { admin.call("session.close", {{"session", session}}); }
  };
};

Json params_of(std::string_view method, const std::string& session) {
  const auto found = all_params().find(method);
  if (found == all_params().end()) return nullptr;
  Json params = found->second;
  if (params.value("session", "") == "SESSION") params["session"] = session;
  return params;
}

/// Returns the role that a method checks. For server methods it is the role at admission, where an
/// owner is a controller.
Role counting_role(const Method& method, Role role) {
  const bool is_of_server = method.row.role_source == RoleSource::connection;
  return is_of_server && role == Role::owner ? Role::controller : role;
}

// OWASP WebSocket: "authorise every message".
TEST_F(EveryMethod, ByEveryRole) {
  for (const Role role : kRoles) {
    for (const Method& method : all_methods()) {
      SCOPED_TRACE(std::string(method.row.name) + " by " + to_string(role));
      const Cast cast = this->cast(role);
      const Closer closer{*admin, cast.session};
      const int id = cast.subject->send(method.row.name, params_of(method.row.name, cast.session));
      const Json reply = cast.subject->wait_reply_at_tick(id);
      const Json error = reply.value("error", Json::object());
      const int code = error.value("code", 0);
      const Role least = method.row.least_role;
      const bool is_refused = error.contains("data") && error["data"].contains("least_role");
      if (role == Role::none && least > Role::none) {
        EXPECT_EQ(code, 1007) << reply;
        continue;
      }
      EXPECT_NE(code, 1007) << reply;
      EXPECT_EQ(is_refused, counting_role(method, role) < least)
          << reply << " (all_params() may lack this method)";
      if (!is_refused) continue;
      EXPECT_EQ(code, 1006);
      EXPECT_EQ(error.at("data").at("role"), to_string(counting_role(method, role)));
      EXPECT_EQ(error.at("data").at("least_role"), to_string(least));
    }
  }
}

TEST_F(EveryMethod, OfASessionNeedsOne) {
  for (const Method& method : all_methods()) {
    if (std::holds_alternative<ServerHandler>(method.handler)) continue;
    const Json error = admin->error(method.row.name, params_of(method.row.name, "s1"));
    EXPECT_EQ(error.at("code"), 1001) << method.row.name;
    EXPECT_EQ(error.at("data").at("kind"), "not_joined");
  }
}

/// Returns a value of another type.
Json wrong_value(const Json& value) {
  if (value.is_string()) return 7;
  return value.is_object() ? Json("x") : Json::object();
}

TEST_F(EveryMethod, RefusesUnknownParametersAndWrongTypes) {
  const Cast cast = this->cast(Role::admin);
  TestClient& client = *cast.subject;
  client.result("control.pause");
  const Json before = client.result("session.hash");
  const auto expect_fault = [&](std::string_view method, const Json& params,
                                const std::string& path) {
    const Json error = client.error(method, params);
    EXPECT_EQ(error.at("code"), -32602) << method << params << error;
    const Json errors = error.at("data").value("errors", Json::array());
    EXPECT_TRUE(std::ranges::any_of(errors, [&](const Json& one) { return one["path"] == path; }))
        << method << params << error;
  };
  for (const Method& method : all_methods()) {
    Json params = params_of(method.row.name, cast.session);
    if (params.is_null()) params = Json::object();
    for (const auto& [name, value] : params.items()) {
      Json wrong = params;
      wrong[name] = wrong_value(value);
      expect_fault(method.row.name, wrong, '/' + name);
    }
    params["colour"] = "red";
    expect_fault(method.row.name, params, "/colour");
  }
  EXPECT_EQ(client.result("session.hash"), before);
}

TEST_F(EveryMethod, IsListedByServerInfo) {
  std::vector<std::string> names;
  for (const Method& method : all_methods()) names.emplace_back(method.row.name);
  const Json listed = connect()->result("server.info").at("methods");
  EXPECT_THAT(listed.get<std::vector<std::string>>(), testing::UnorderedElementsAreArray(names));
}

}  // namespace
}  // namespace vat::test::every_method_test
