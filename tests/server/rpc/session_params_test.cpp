// Parameters of each method: rejected values, their messages, and no change of state.

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_params_test {
namespace {

struct BadParams {
  std::string method;
  std::string params;
  std::string path;     // path of the first error
  std::string message;  // text that the message contains
  int code = -32602;
  std::string kind = "invalid_params";
};

const std::vector<BadParams>& bad_params() {
  static const std::string kTooLong(65, 'n');
  static const std::string kBody =
      R"({"body":{"name":"b","kind":"rigid","material":"wood","spacing":0.1,
        "shape":{"type":"sphere","radius":0.1},"position":[0.3,0.7,0.8]},"state":)";
  static const std::vector<BadParams> kCases = {
      {"session.create", R"({"scene":"mixed"})", "/name", "must be given"},
      {"session.create", R"({"name":"n"})", "/scene", "must be given"},
      {"session.create", R"({"name":")" + kTooLong + R"(","scene":"mixed"})", "/name",
       "text of at most 64 bytes"},
      {"session.create", R"({"name":"a\u0007b","scene":"mixed"})", "/name", "control characters"},
      {"session.create", R"({"name":"n","scene":{}})", "/scene/format", "must be given"},
      {"session.close", "{}", "/session", "must be given"},
      {"scene.load", "{}", "/scene", "must be given"},
      {"scene.load", R"({"scene":[]})", "/scene", "must be an object"},
      {"scene.load", R"({"scene":{"format":"vat.scene/1","materials":[{"name":"w","density":1}],
        "bodies":[{"name":"b","kind":"rigid","material":"w","spacing":1,
        "shape":{"type":"mesh","file":"meshes/duck.obj"}}]}})",
       "/scene/bodies/0/shape/file", "must contain vertices and triangles"},
      {"control.step", R"({"ticks":0})", "/ticks", "from 1 to 1000"},
      {"control.step", R"({"ticks":1001})", "/ticks", "from 1 to 1000"},
      {"control.set_speed", "{}", "/speed", "must be given"},
      {"control.set_speed", R"({"speed":0.049})", "/speed", "from 0.05 to 4"},
      {"control.set_speed", R"({"speed":4.001})", "/speed", "from 0.05 to 4"},
      {"world.add_body", "{}", "/body", "must be given"},
      {"world.add_body", R"({"body":{}})", "/body/name", "must be given"},
      {"world.add_body", R"({"body":{"name":"ball","kind":"rigid","material":"wood","spacing":0.1,
        "shape":{"type":"sphere","radius":0.15},"position":[0.5,0.5,0.5]}})",
       "/body/name", "not be the name of another body"},
      {"world.add_body", kBody + R"([]})", "/state", ""},
      {"world.add_body", kBody + R"({"center_of_mass":[0.3,0.7,0.8],"orientation":[1,0,0,0],
        "angular_velocity":[0,0,0]}})",
       "/state/velocity", "must be given"},
      {"world.add_body", kBody + R"({"center_of_mass":[0.3,0.7,0.8],"orientation":[1,0,0,0],
        "angular_velocity":[0,0,0],"velocity":[0,0,0],"colour":1}})",
       "/state/colour", "not a known"},
      {"world.add_body", kBody + R"({"center_of_mass":[0.3,0.7,50],"orientation":[1,0,0,0],
        "velocity":[0,0,0],"angular_velocity":[0,0,0]}})",
       "/state", ""},
      {"world.remove_body", "{}", "/body", "must be given"},
      {"world.melt_body", R"({"body":2})", "/material", "must be given"},
      {"world.melt_body", R"({"body":2,"material":"wood"})", "/material", "liquid constants"},
      {"world.melt_body", R"({"body":3,"material":"water"})", "/body", "only a deformable body"},
      {"world.set_emitter", R"({"emitter":"tap"})", "/open", "must be given"},
      {"world.set_emitter", R"({"emitter":"tap","open":true})", "/emitter", "scene's emitters"},
      {"world.set_gravity", R"({"gravity":[0,0]})", "/gravity", "[x, y, z]"},
      {"world.set_gravity", R"({"gravity":[0,0,-1001]})", "/gravity", "at most 1000"},
      {"world.set_interface", R"({"interface":{"materials":["water","gold"],"stiffness":1}})",
       "/interface/materials/1", "one of the scene's materials"},
      {"world.apply_force", R"({"body":3,"force":[0,0,1],"duration":0})", "/duration",
       "above 0 and at most 3600"},
      {"world.apply_force", R"({"body":3,"force":[0,0,1],"duration":3601})", "/duration",
       "above 0 and at most 3600"},
      {"world.apply_force", R"({"body":3,"force":[0,0,1e300],"duration":1})", "/force",
       "at most 1e+12"},
      {"world.move_body", R"({"body":3,"position":[0,0,0]})", "/position", ""},
      {"world.move_body", R"({"body":3})", "/position", ""},
      {"world.move_body", R"({"body":3,"position":[0.5,0.5,0.7],"orientation":[1,0]})",
       "/orientation", ""},
      {"world.move_body", R"({"body":3,"position":[0.5,0.5,0.7],"orientation":[1,0,0,3]})",
       "/orientation/3", ""},
      {"world.move_body", R"({"body":2,"position":[0.5,0.5,0.7],"orientation":[1,0,0,0]})",
       "/orientation", ""},
      {"world.move_body", R"({"body":3,"position":[0.5,0.5,0.7],"velocity":[0,0,2e4]})",
       "/velocity", ""},
      {"world.set_material", R"({"material":{"name":"wood","density":0}})", "/material/density",
       "from"},
      {"world.move_vat", R"({"offset":[0,1.01,0]})", "/offset", ""},
      {"world.set_numerics", R"({"integrator":"leapfrog"})", "/integrator", ""},
      {"world.set_numerics", R"({"step":0.003})", "/step", ""},
      {"world.set_numerics", R"({"step":1})", "/step", ""},
      {"world.set_numerics", R"({"step":0.001,"tick":0.01})", "/tick", ""},
      {"world.set_numerics", R"({"control":"free"})", "/control", ""},
      {"world.set_numerics", R"({"tolerance":2})", "/tolerance", ""},
      {"world.set_numerics", R"({"density_tolerance":1})", "/density_tolerance", ""},
      {"world.set_numerics", R"({"divergence_tolerance":0})", "/divergence_tolerance", ""},
      {"world.set_numerics", "{}", "/integrator", "must be given, unless another member is given"},
      {"world.remove_body", R"({"body":"ball"})", "/body", "the id of a body, not a name"},
      {"grab.start", R"({"body":3,"particle":0})", "/target", "must be given"},
      {"grab.start", R"({"body":3,"particle":-1,"target":[0,0,0]})", "/particle", "from 0"},
      {"grab.start", R"({"body":3,"particle":100000,"target":[0,0,0]})", "/particle",
       "must be below 19"},
      {"grab.start", R"({"body":3,"particle":0,"target":[0,0,1e7]})", "/target/2",
       "from -1000000 to 1000000"},
      {"grab.move", R"({"grab":1,"target":[0,0,0]})", "/grab", "a grab of this participant"},
      {"grab.end", R"({"grab":1})", "/grab", "a grab of this participant"},
      {"frames.subscribe", R"({"every":0})", "/every", "from 1 to 100"},
      {"frames.subscribe", R"({"every":101})", "/every", "from 1 to 100"},
      {"frames.subscribe", R"({"max_error":-1})", "/max_error", "from 0 to 1000000"},
      {"frames.subscribe", R"({"detail":4})", "/detail", "from 0 to 3"},
      {"frames.subscribe", R"({"region":{"min":[0,0,0]}})", "/region/max", "must be given"},
      {"frames.subscribe", R"({"region":{"min":[0,0,0],"max":[1,-1,1]}})", "/region/max",
       "below min"},
      {"frames.subscribe", R"({"region":{"min":[0,0,0],"max":[1,1,1],"size":1}})", "/region/size",
       "not a known"},
      {"frames.subscribe", R"({"attributes":{"colour":1}})", "/attributes/colour", "not a known"},
      {"frames.subscribe", R"({"attributes":{"speed":0}})", "/attributes/speed", "from"},
      {"frames.ack", "{}", "/number", "must be given"},
      {"frames.ack", R"({"number":0})", "/number", "from 1 to"},
      {"frames.ack", R"({"number":1})", "/number", "a frame that was sent"},
      {"state.query", R"({"bodies":[true]})", "/bodies/0", "the id or the name of a body"},
      {"state.query", R"({"bodies":["ball",-1]})", "/bodies/1", "from 0 to 4294967295"},
      {"session.save", R"({"name":""})", "/name", ""},
      {"recording.import", R"({"size":0,"offset":0,"data":""})", "/size", "from 1 to"},
      {"recording.import", R"({"size":9,"offset":0,"data":"+"})", "/data", "must be base64"},
      {"replay.open", "{}", "/session", "either a session or a recording"},
      {"replay.seek", "{}", "/position", "either a position or a tick"},
      {"replay.seek", R"({"tick":1,"position":1})", "/position", "either a position or a tick"},
      {"session.join", R"({"session":"s2"})", "/session", "", 1002, "no_such_session"},
      {"session.join", R"({"session":""})", "/session", "", 1002, "no_such_session"},
      {"session.join", R"({"session":"s01"})", "/session", "", 1002, "no_such_session"},
      {"session.join", R"({"role":"owner"})", "/role", R"("viewer", "controller")"},
      {"session.close", R"({"session":"s2"})", "/session", "", 1002, "no_such_session"},
      {"world.remove_body", R"({"body":0})", "/body", "", 1003, "no_such_body"},
      {"world.remove_body", R"({"body":4})", "/body", "", 1003, "no_such_body"},
      {"world.melt_body", R"({"body":4,"material":"water"})", "/body", "", 1003, "no_such_body"},
      {"world.move_body", R"({"body":9,"position":[0,0,0]})", "/body", "", 1003, "no_such_body"},
      {"world.apply_force", R"({"body":9,"force":[0,0,1],"duration":1})", "/body", "", 1003,
       "no_such_body"},
      {"grab.start", R"({"body":9,"particle":0,"target":[0,0,0]})", "/body", "", 1003,
       "no_such_body"},
      {"grab.start", R"({"body":"brick","particle":0,"target":[0,0,0]})", "/body", "", 1003,
       "no_such_body"},
      {"state.query", R"({"bodies":["ball","brick"]})", "/bodies/1", "", 1003, "no_such_body"},
      {"state.query", R"({"bodies":[9]})", "/bodies/0", "", 1003, "no_such_body"},
      {"session.create", R"({"name":"n","scene":"nowhere"})", "/scene", "", 1004, "no_such_scene"},
      {"scene.load", R"({"scene":"../mixed"})", "/scene", "", 1004, "no_such_scene"},
  };
  return kCases;
}

class BadParameters : public SessionTest {
 protected:
  /// Returns all state of the server that a client can query.
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
    EXPECT_EQ(error.at("code"), bad.code) << error;
    const Json& data = error.at("data");
    EXPECT_EQ(data.at("kind"), bad.kind);
    EXPECT_EQ(data.at("path"), bad.path) << error;
    EXPECT_NE(error.at("message").get<std::string>().find(bad.message), std::string::npos) << error;
    if (bad.code == -32602) {
      ASSERT_FALSE(data.at("errors").empty());
      EXPECT_EQ(data.at("errors").at(0).at("path"), bad.path);
    }
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

class GoodParameters : public SessionTest {};

TEST_F(GoodParameters, TheEndsOfTheRangesAreAllowed) {
  client->result("control.set_speed", {{"speed", 0.05}});
  client->result("control.set_speed", {{"speed", 4}});
  EXPECT_EQ(client->result("control.step", {{"ticks", 1}}).at("tick"), 1);
  client->result("control.step", {{"ticks", kMaxTicksPerStep}});
  client->create_session("mixed", std::string(kMaxNameLength, 'n'));
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
  // The lattice is symmetric, so the sums of less than a hundred particles are exact except for
  // rounding.
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
  const Json info = client->result("server.info");
  EXPECT_EQ(info.at("name"), "vat");
  EXPECT_EQ(info.at("version"), "1.2.3");
  EXPECT_EQ(info.at("protocol"), "vat.v1");
  EXPECT_EQ(info.at("access"), "open");
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
