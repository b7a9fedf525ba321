// Parameters of each method: what is refused, with which words, and that nothing changes by it.

#include "tests/server/session_fixture.h"

namespace vat::test::session_params_test {
namespace {

struct BadParams {
  std::string method;
  std::string params;
  std::string path;     // of the first error
  std::string message;  // what it contains: the rule that was broken
};

const std::vector<BadParams>& bad_params() {
  static const std::string kTooLong(65, 'n');
  static const std::vector<BadParams> kCases = {
      {"session.create", R"({"scene":"mixed"})", "/name", "must be given"},
      {"session.create", R"({"name":"n"})", "/scene", "must be given"},
      {"session.create", R"({"name":7,"scene":"mixed"})", "/name", "text of at most 64 bytes"},
      {"session.create", R"({"name":")" + kTooLong + R"(","scene":"mixed"})", "/name",
       "text of at most 64 bytes"},
      {"session.create", R"({"name":"a\u0007b","scene":"mixed"})", "/name", "control characters"},
      {"session.create", R"({"name":"n","scene":7})", "/scene", "must be an object"},
      {"session.create", R"({"name":"n","scene":{}})", "/scene/format", "must be given"},
      {"session.create", R"({"name":"n","scene":"mixed","speed":1})", "/speed", "not a known"},
      {"session.list", R"({"all":true})", "/all", "not a known"},
      {"session.join", R"({"session":1})", "/session", "text of at most 64 bytes"},
      {"session.leave", R"({"session":"s1"})", "/session", "not a known"},
      {"session.close", "{}", "/session", "must be given"},
      {"scene.list", R"({"x":0})", "/x", "not a known"},
      {"scene.load", "{}", "/scene", "must be given"},
      {"scene.load", R"({"scene":[]})", "/scene", "must be an object"},
      {"scene.load", R"({"scene":{"format":"vat.scene/9","materials":[],"bodies":[]}})",
       "/scene/format", "vat.scene/1"},
      {"scene.load", R"({"scene":{"format":"vat.scene/1","materials":[{"name":"w","density":1e20}],
        "bodies":[]}})",
       "/scene/materials/0/density", "from 1e-06 to 1e+09"},
      {"scene.load", R"({"scene":{"format":"vat.scene/1","materials":[{"name":"w","density":1}],
        "bodies":[{"name":"b","kind":"rigid","material":"w","spacing":1,
        "shape":{"type":"mesh","file":"meshes/duck.obj"}}]}})",
       "/scene/bodies/0/shape/file", "must hold its vertices and triangles"},
      {"control.play", R"({"speed":2})", "/speed", "not a known"},
      {"control.pause", R"({"x":null})", "/x", "not a known"},
      {"control.reset", R"({"tick":3})", "/tick", "not a known"},
      {"control.step", R"({"ticks":0})", "/ticks", "from 1 to 1000"},
      {"control.step", R"({"ticks":1001})", "/ticks", "from 1 to 1000"},
      {"control.step", R"({"ticks":-1})", "/ticks", "from 1 to 1000"},
      {"control.step", R"({"ticks":1.5})", "/ticks", "from 1 to 1000"},
      {"control.step", R"({"ticks":"2"})", "/ticks", "from 1 to 1000"},
      {"control.set_speed", "{}", "/speed", "must be given"},
      {"control.set_speed", R"({"speed":0})", "/speed", "from 0.05 to 4"},
      {"control.set_speed", R"({"speed":0.049})", "/speed", "from 0.05 to 4"},
      {"control.set_speed", R"({"speed":4.001})", "/speed", "from 0.05 to 4"},
      {"control.set_speed", R"({"speed":true})", "/speed", "from 0.05 to 4"},
      {"world.add_body", "{}", "/body", "must be given"},
      {"world.add_body", R"({"body":{}})", "/body/name", "must be given"},
      {"world.add_body", R"({"body":{"name":"ball","kind":"rigid","material":"wood","spacing":0.1,
        "shape":{"type":"sphere","radius":0.15},"position":[0.5,0.5,0.5]}})",
       "/body/name", "not be the name of another body"},
      {"world.add_body", R"({"body":{"name":"b","kind":"rigid","material":"lead","spacing":0.1,
        "shape":{"type":"sphere","radius":0.15},"position":[0.5,0.5,0.5]}})",
       "/body/material", "one of the scene's materials"},
      {"world.add_body", R"({"body":{"name":"b","kind":"rigid","material":"wood","spacing":0,
        "shape":{"type":"sphere","radius":0.15},"position":[0.5,0.5,0.5]}})",
       "/body/spacing", "1e-06"},
      {"world.remove_body", "{}", "/body", "must be given"},
      {"world.remove_body", R"({"body":"ball"})", "/body", "from 0 to 4294967295"},
      {"world.melt_body", R"({"body":2})", "/material", "must be given"},
      {"world.melt_body", R"({"body":2,"material":"wood"})", "/material", "liquid constants"},
      {"world.melt_body", R"({"body":3,"material":"water"})", "/body", "only a deformable body"},
      {"world.set_emitter", R"({"emitter":"tap"})", "/open", "must be given"},
      {"world.set_emitter", R"({"emitter":"tap","open":true})", "/emitter", "scene's emitters"},
      {"world.set_gravity", R"({"gravity":9.81})", "/gravity", "[x, y, z]"},
      {"world.set_gravity", R"({"gravity":[0,0]})", "/gravity", "[x, y, z]"},
      {"world.set_gravity", R"({"gravity":[0,0,-1001]})", "/gravity", "at most 1000"},
      {"world.set_interface", R"({"interface":{"materials":["water","gold"],"stiffness":1}})",
       "/interface/materials/1", "one of the scene's materials"},
      {"world.set_interface", R"({"interface":{"materials":["water","vat"],"stiffness":-1}})",
       "/interface/stiffness", "from 0 to"},
      {"world.apply_force", R"({"body":3,"force":[0,0,1],"duration":0})", "/duration",
       "above 0 and at most 3600"},
      {"world.apply_force", R"({"body":3,"force":[0,0,1],"duration":3601})", "/duration",
       "above 0 and at most 3600"},
      {"world.apply_force", R"({"body":3,"force":[0,"a",1],"duration":1})", "/force/1", "finite"},
      {"world.apply_force", R"({"body":3,"force":[0,0,1e300],"duration":1})", "/force",
       "at most 1e+12"},
      {"grab.start", R"({"body":3,"particle":0})", "/target", "must be given"},
      {"grab.start", R"({"body":3,"particle":-1,"target":[0,0,0]})", "/particle", "from 0"},
      {"grab.start", R"({"body":3,"particle":100000,"target":[0,0,0]})", "/particle",
       "must be below 19"},
      {"grab.start", R"({"body":3,"particle":0,"target":[0,0,1e7]})", "/target/2",
       "from -1000000 to 1000000"},
      {"grab.move", R"({"grab":1,"target":[0,0,0]})", "/grab", "a grab of this participant"},
      {"grab.end", R"({"grab":1})", "/grab", "a grab of this participant"},
      {"grab.end", R"({"grab":1e300})", "/grab", "from 0 to"},
      {"frames.subscribe", R"({"every":0})", "/every", "from 1 to 100"},
      {"frames.subscribe", R"({"every":101})", "/every", "from 1 to 100"},
      {"frames.subscribe", R"({"max_error":-1})", "/max_error", "from 0 to 1000000"},
      {"frames.unsubscribe", R"({"every":1})", "/every", "not a known"},
      {"frames.ack", "{}", "/number", "must be given"},
      {"frames.ack", R"({"number":0})", "/number", "from 1 to"},
      {"frames.ack", R"({"number":1})", "/number", "a frame that was sent"},
      {"state.query", R"({"bodies":"ball"})", "/bodies", "must be a list"},
      {"state.query", R"({"bodies":[true]})", "/bodies/0", "from 0 to 4294967295"},
      {"state.query", R"({"bodies":["ball",-1]})", "/bodies/1", "from 0 to 4294967295"},
      {"session.hash", R"({"x":1})", "/x", "not a known"},
      {"session.stats", R"({"x":1})", "/x", "not a known"},
      {"recording.export", R"({"x":1})", "/x", "not a known"},
      {"recording.import", R"({"size":0,"offset":0,"data":""})", "/size", "from 1 to"},
      {"recording.import", R"({"size":9,"offset":0,"data":"+"})", "/data", "must be base64"},
      {"replay.open", "{}", "/session", "either a session or a recording"},
      {"replay.seek", "{}", "/position", "either a position or a tick"},
      {"replay.seek", R"({"tick":1,"position":1})", "/position", "either a position or a tick"},
  };
  return kCases;
}

class BadParameters : public SessionTest {
 protected:
  /// All that a client can see of the server's state.
  Json observe() {
    return {client->result("session.hash"), client->result("session.list"),
            client->result("state.query"), client->result("session.join").at("description")};
  }
};

TEST_F(BadParameters, AreNamedWithTheAllowedRangeAndChangeNothing) {
  const Json before = observe();
  for (const BadParams& bad : bad_params()) {
    SCOPED_TRACE(bad.method + " " + bad.params);
    const Json error = client->error(bad.method, Json::parse(bad.params));
    if (error.is_null()) continue;
    EXPECT_EQ(error.at("code"), -32602) << error;
    const Json& data = error.at("data");
    EXPECT_EQ(data.at("kind"), "invalid_params");
    EXPECT_EQ(data.at("path"), bad.path) << error;
    EXPECT_NE(error.at("message").get<std::string>().find(bad.message), std::string::npos) << error;
    ASSERT_FALSE(data.at("errors").empty());
    EXPECT_EQ(data.at("errors").at(0).at("path"), bad.path);
    EXPECT_EQ(observe(), before);
  }
}

TEST_F(BadParameters, AreReportedAllAtOnce) {
  const Json error = client->error("world.apply_force",
                                   {{"body", -1}, {"force", {0, 0, nullptr}}, {"x", 1}, {"y", 2}});
  std::vector<std::string> paths;
  for (const Json& entry : error.at("data").at("errors")) paths.push_back(entry.at("path"));
  EXPECT_EQ(paths, (std::vector<std::string>{"/body", "/force/2", "/duration", "/x", "/y"}));
}

TEST_F(BadParameters, WhatIsNotThereHasAnErrorOfItsOwn) {
  const Json before = observe();
  const Json target = {0, 0, 0};
  const std::vector<std::tuple<std::string, Json, int, std::string, std::string>> cases = {
      {"session.join", {{"session", "s2"}}, 1002, "no_such_session", "/session"},
      {"session.join", {{"session", ""}}, 1002, "no_such_session", "/session"},
      {"session.join", {{"session", "s01"}}, 1002, "no_such_session", "/session"},
      {"session.close", {{"session", "s2"}}, 1002, "no_such_session", "/session"},
      {"world.remove_body", {{"body", 0}}, 1003, "no_such_body", "/body"},
      {"world.remove_body", {{"body", 4}}, 1003, "no_such_body", "/body"},
      {"world.melt_body", {{"body", 4}, {"material", "water"}}, 1003, "no_such_body", "/body"},
      {"world.apply_force",
       {{"body", 9}, {"force", {0, 0, 1}}, {"duration", 1}},
       1003,
       "no_such_body",
       "/body"},
      {"grab.start",
       {{"body", 9}, {"particle", 0}, {"target", target}},
       1003,
       "no_such_body",
       "/body"},
      {"state.query", {{"bodies", {"ball", "brick"}}}, 1003, "no_such_body", "/bodies/1"},
      {"state.query", {{"bodies", {9}}}, 1003, "no_such_body", "/bodies/0"},
      {"session.create", {{"name", "n"}, {"scene", "nowhere"}}, 1004, "no_such_scene", "/scene"},
      {"scene.load", {{"scene", "../mixed"}}, 1004, "no_such_scene", "/scene"},
  };
  for (const auto& [method, params, code, kind, path] : cases) {
    const Json error = client->error(method, params);
    EXPECT_EQ(error.at("code"), code) << method << params;
    EXPECT_EQ(error.at("data").at("kind"), kind);
    EXPECT_EQ(error.at("data").at("path"), path) << method << params;
    EXPECT_EQ(observe(), before);
  }
}

TEST_F(BadParameters, MethodsOfASessionNeedOne) {
  const auto outsider = connect();
  const Json target = {0, 0, 0};
  const std::vector<std::pair<std::string, Json>> calls = {
      {"session.leave", nullptr},
      {"scene.get", nullptr},
      {"scene.load", {{"scene", "mixed"}}},
      {"control.play", nullptr},
      {"control.pause", nullptr},
      {"control.step", nullptr},
      {"control.reset", nullptr},
      {"control.set_speed", {{"speed", 1}}},
      {"world.add_body", {{"body", Json::object()}}},
      {"world.remove_body", {{"body", 1}}},
      {"world.melt_body", {{"body", 1}, {"material", "water"}}},
      {"world.set_emitter", {{"emitter", "tap"}, {"open", true}}},
      {"world.set_gravity", {{"gravity", target}}},
      {"world.set_interface", {{"interface", Json::object()}}},
      {"world.apply_force", {{"body", 1}, {"force", target}, {"duration", 1}}},
      {"world.move_body", {{"body", 1}, {"position", target}}},
      {"world.set_material", {{"material", Json::object()}}},
      {"world.set_numerics", {{"integrator", "heun"}}},
      {"world.move_vat", {{"offset", target}}},
      {"grab.start", {{"body", 1}, {"particle", 0}, {"target", target}}},
      {"grab.move", {{"grab", 1}, {"target", target}}},
      {"grab.end", {{"grab", 1}}},
      {"frames.subscribe", nullptr},
      {"frames.unsubscribe", nullptr},
      {"state.query", nullptr},
      {"state.connections", nullptr},
      {"session.hash", nullptr},
      {"session.stats", nullptr},
      {"recording.export", nullptr},
      {"replay.info", nullptr},
      {"replay.seek", {{"tick", 1}}},
      {"session.configure", nullptr},
      {"session.invite", {{"role", "viewer"}}},
      {"participant.rename", {{"name", "x"}}},
      {"participant.set_role", {{"participant", 1}, {"role", "viewer"}}},
      {"participant.kick", {{"participant", 1}}},
      {"control.request", nullptr},
      {"control.hand_over", {{"participant", 1}}},
      {"presence.list", nullptr},
      {"presence.point", nullptr},
  };
  for (const auto& [method, params] : calls) {
    const Json error = outsider->error(method, params);
    EXPECT_EQ(error.at("code"), 1001) << method;
    EXPECT_EQ(error.at("data").at("kind"), "not_joined");
  }
}

class GoodParameters : public SessionTest {};

TEST_F(GoodParameters, EveryMethodOfTheProtocolIsThere) {
  const Json info = client->result("server.info");
  EXPECT_EQ(
      info.at("methods"),
      Json(
          {"server.info",       "scene.list",         "scene.get",           "session.create",
           "session.list",      "session.join",       "session.leave",       "session.close",
           "scene.load",        "control.play",       "control.pause",       "control.step",
           "control.reset",     "control.set_speed",  "world.add_body",      "world.remove_body",
           "world.melt_body",   "world.set_emitter",  "world.set_gravity",   "world.set_interface",
           "world.apply_force", "world.move_body",    "world.set_material",  "world.set_numerics",
           "world.move_vat",    "grab.start",         "grab.move",           "grab.end",
           "frames.subscribe",  "frames.unsubscribe", "frames.ack",          "state.query",
           "state.connections", "session.hash",       "session.stats",       "recording.export",
           "session.configure", "session.invite",     "participant.rename",  "participant.set_role",
           "participant.kick",  "control.request",    "control.hand_over",   "presence.list",
           "presence.point",    "access.enter",       "access.ticket",       "recording.import",
           "replay.open",       "replay.info",        "replay.seek",         "session.save",
           "session.load",      "session.saves",      "session.delete_save", "scene.save",
           "scene.delete",      "server.sessions",    "server.drain"}));
  EXPECT_EQ(info.at("name"), "vat");
  EXPECT_EQ(info.at("version"), "1.2.3");
  EXPECT_EQ(info.at("protocol"), "vat.v1");
  EXPECT_EQ(info.at("limits").at("sessions"), 16);
  EXPECT_EQ(info.at("limits").at("ticks_per_step"), 1000);
}

TEST_F(GoodParameters, TheEndsOfTheRangesAreAllowed) {
  client->result("control.set_speed", {{"speed", 0.05}});
  client->result("control.set_speed", {{"speed", 4}});
  EXPECT_EQ(client->result("control.step", {{"ticks", 1}}).at("tick"), 1);
  client->result("frames.subscribe", {{"every", 1}, {"max_error", 0}});
  client->result("frames.subscribe", {{"every", 100}, {"max_error", 1e6}});
  client->result("world.set_gravity", {{"gravity", {1000, -1000, 0}}});
  client->result("world.apply_force", {{"body", 3}, {"force", {0, 0, 0}}, {"duration", 3600}});
}

TEST_F(GoodParameters, TheStateHasAllThatTheProtocolNames) {
  const Json state = client->result("state.query", {{"bodies", {"ball", 1, "cube"}}});
  EXPECT_EQ(state.at("tick"), 0);
  EXPECT_EQ(state.at("time"), 0);
  const Json& ball = state.at("bodies").at(0);
  EXPECT_EQ(ball.at("name"), "ball");
  ASSERT_EQ(ball.at("center_of_mass").size(), 3u);
  // Of a symmetric lattice of fewer than a hundred particles: exact but for rounding.
  for (const Json& x : ball.at("center_of_mass")) EXPECT_NEAR(x.get<double>(), 0.7, 1e-14);
  EXPECT_EQ(ball.at("orientation"), Json({1, 0, 0, 0}));
  EXPECT_EQ(ball.at("velocity"), Json({0, 0, 0}));
  EXPECT_EQ(ball.at("angular_velocity"), Json({0, 0, 0}));
  EXPECT_EQ(state.at("bodies").at(1).at("body"), 1);
  EXPECT_EQ(state.at("bodies").at(1).at("kind"), "liquid");
  EXPECT_FALSE(state.at("bodies").at(1).contains("orientation"));
  EXPECT_EQ(state.at("bodies").at(2).at("kind"), "deformable");
  EXPECT_EQ(client->result("state.query").at("bodies").size(), 3u);
  EXPECT_EQ(client->result("state.query", {{"bodies", Json::array()}}).at("bodies").size(), 0u);
}

TEST_F(GoodParameters, TheDescriptionHasAllThatTheProtocolNames) {
  const Json joined = client->result("session.join");
  EXPECT_EQ(joined.at("session"), "s1");
  const Json& description = joined.at("description");
  EXPECT_EQ(description.at("name"), "first");
  EXPECT_EQ(description.at("scene"), "mixed");
  EXPECT_EQ(description.at("title"), "Mixed");
  EXPECT_EQ(description.at("tick_seconds"), 0.02);
  EXPECT_EQ(description.at("playing"), false);
  EXPECT_EQ(description.at("vat"), Json({{"min", {0, 0, 0}}, {"max", {1, 1, 1}}, {"lid", true}}));
  const Json& bodies = description.at("bodies");
  ASSERT_EQ(bodies.size(), 3u);
  EXPECT_EQ(bodies.at(2).at("material"), "wood");
  EXPECT_EQ(bodies.at(2).at("local_positions").size(),
            3 * bodies.at(2).at("particles").get<std::size_t>());
  EXPECT_FALSE(bodies.at(1).contains("local_positions"));
}

}  // namespace
}  // namespace vat::test::session_params_test
