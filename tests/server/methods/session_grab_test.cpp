// grab.*: a grab belongs to the client that started it, and ends with that client.

#include "core/limits.h"
#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_grab_test {
namespace {

constexpr BodyId kBall = 3;

class SessionGrabs : public SessionTest {
 protected:
  /// A simulation that receives the same commands.
  Simulation reference = mixed_simulation();

  const Json kTarget = {0.5, 0.5, 0.9};
  const Vec3 target{0.5, 0.5, 0.9};
};

TEST_F(SessionGrabs, HoldMoveAndEnd) {
  const Json start{{"body", "ball"}, {"particle", 0}, {"target", kTarget}};
  const Json grab = client->result("grab.start", start).at("grab");
  client->result("control.step", {{"ticks", 50}});
  client->result("grab.move", {{"grab", grab}, {"target", {0.5, 0.5, 0.7}}});
  client->result("control.step", {{"ticks", 50}});
  client->result("grab.end", {{"grab", grab}});
  client->result("control.step", {{"ticks", 20}});

  ASSERT_TRUE(reference.grab_start(1, kBall, 0, target));
  advance_ticks(reference, 50);
  ASSERT_TRUE(reference.grab_move(1, Vec3(0.5, 0.5, 0.7)));
  advance_ticks(reference, 50);
  ASSERT_TRUE(reference.grab_end(1));
  advance_ticks(reference, 20);
  EXPECT_EQ(hash(), hash_of(reference));
  EXPECT_EQ(client->error("grab.end", {{"grab", grab}}).at("code"), -32602) << "the grab has ended";
}

// The first tick drains a corner of the pool. The other particles keep their numbers.
TEST_F(SessionGrabs, NameAParticleByItsNumber) {
  Json scene = Json::parse(mixed_scene_text());
  scene["drains"] = Json::parse(R"([{"name": "hole", "min": [0, 0, 0], "max": [0.5, 0.5, 0.5]}])");
  client->result("scene.load", {{"scene", scene}});
  client->result("control.step");
  const Json state = client->result("state.query", {{"bodies", {"pool"}}}).at("bodies").at(0);
  const auto numbers = state.at("numbers").get<std::vector<std::uint32_t>>();
  ASSERT_EQ(numbers.size(), state.at("positions").size());
  ASSERT_GT(numbers.back(), numbers.size() - 1) << "some particles are drained";
  std::uint32_t gone = 0;
  while (numbers[gone] == gone) ++gone;
  const Json params = {{"body", state.at("body")}, {"particle", gone}, {"target", kTarget}};
  EXPECT_EQ(client->error("grab.start", params).at("data").at("path"), "/particle");
  Json last = params;
  last["particle"] = numbers.back();
  client->result("grab.start", last);
  const double before = state.at("positions").back().at(2);
  client->result("control.step", {{"ticks", 30}});
  const Json after = client->result("state.query", {{"bodies", {"pool"}}}).at("bodies").at(0);
  ASSERT_EQ(after.at("numbers").back(), numbers.back());
  EXPECT_GT(after.at("positions").back().at(2), before + 0.05) << "the particle is pulled up";
}

TEST_F(SessionGrabs, OfAnotherClientAreProtected) {
  const auto other = join();
  const std::uint64_t grab = client->grab(kBall);
  const std::string before = hash();
  const Json moved = other->error("grab.move", {{"grab", grab}, {"target", {0, 0, 0}}});
  EXPECT_EQ(moved.at("code"), 1006);
  EXPECT_EQ(moved.at("data").at("kind"), "not_allowed");
  EXPECT_EQ(other->error("grab.end", {{"grab", grab}}).at("code"), 1006);
  EXPECT_EQ(hash(), before);
  client->result("grab.end", {{"grab", grab}});
}

TEST_F(SessionGrabs, EndWhenTheirClientLeavesOrJoinsAnotherSession) {
  const auto other = join();
  const std::uint64_t first = other->grab(kBall);
  other->result("session.leave");
  other->result("session.join");
  EXPECT_EQ(other->error("grab.end", {{"grab", first}}).at("code"), -32602);
  const std::uint64_t second = other->grab(kBall);
  other->create_session();
  other->result("session.join", {{"session", "s2"}});
  EXPECT_EQ(client->error("grab.end", {{"grab", second}}).at("code"), -32602)
      << "the grab has ended";
  other->result("session.join", {{"session", "s1"}});
  const std::uint64_t third = other->grab(kBall);
  other->result("session.join", {{"session", "s1"}});
  EXPECT_EQ(other->error("grab.end", {{"grab", third}}).at("code"), -32602)
      << "a repeated join is a new start";
  client->result("control.step", {{"ticks", 5}});
  EXPECT_EQ(hash(), mixed_hash_after(5)) << "the ball is not grabbed";
}

TEST_F(SessionGrabs, EndWithTheirBodyOrScene) {
  const std::uint64_t cube = client->grab(2);
  const std::uint64_t ball = client->grab(kBall);
  client->result("world.remove_body", {{"body", 2}});
  EXPECT_EQ(client->error("grab.end", {{"grab", cube}}).at("code"), -32602);
  client->result("grab.move", {{"grab", ball}, {"target", {0.5, 0.5, 0.5}}});
  client->result("control.reset");
  EXPECT_EQ(client->error("grab.end", {{"grab", ball}}).at("code"), -32602);
  const std::uint64_t again = client->grab(kBall);
  client->result("scene.load", {{"scene", "mixed"}});
  EXPECT_EQ(client->error("grab.end", {{"grab", again}}).at("code"), -32602);
  client->result("control.step", {{"ticks", 3}});
}

// One body per client, because only one client can grab a body at a time.
TEST_F(SessionGrabs, OfAClientAreAtMostTenAndOfASessionSixtyFour) {
  const auto add_ball = [&](double x) {
    Json ball = wooden_ball("ball at " + std::to_string(x), {x, 5, 5});
    ball["material"] = "steel";
    return client->result("world.add_body", {{"body", ball}}).at("body").get<BodyId>();
  };
  const auto expect_limit = [&](TestClient& by, BodyId body, const char* limit, std::size_t most) {
    const Json params{{"body", body}, {"particle", 0}, {"target", kTarget}};
    const Json error = by.error("grab.start", params);
    EXPECT_EQ(error.at("data").at("limit"), limit);
    EXPECT_EQ(error.at("data").at("maximum"), most);
  };
  client->result("scene.load",
                 {{"scene", "unstable"}});  // this scene has no vat that would limit positions
  std::vector<std::unique_ptr<TestClient>> clients;
  BodyId body = 0;
  for (std::size_t i = 0; i < kMaxGrabs; ++i) {
    if (i % 10 == 0) {
      if (i > 0) expect_limit(*clients.back(), body, "grabs_per_client", 10);
      clients.push_back(join());
      body = add_ball(static_cast<double>(i));
    }
    clients.back()->grab(body);
  }
  const BodyId free = add_ball(-10);
  expect_limit(*client, free, "grabs_per_session", kMaxGrabs);
  clients.front()->result("session.leave");
  client->grab(free);
}

TEST_F(SessionGrabs, ForcesOfASessionAreBoundedToo) {
  const Json force = {{"body", kBall}, {"force", {0, 0, 0.01}}, {"duration", 0.01}};
  for (std::size_t i = 0; i < kMaxAppliedForces; ++i) client->result("world.apply_force", force);
  const std::string before = hash();
  const Json error = client->error("world.apply_force", force);
  EXPECT_EQ(error.at("data").at("limit"), "applied_forces");
  EXPECT_EQ(error.at("data").at("maximum"), kMaxAppliedForces);
  EXPECT_EQ(hash(), before);
  client->result("control.step");  // the grabs end
  client->result("world.apply_force", force);
}

}  // namespace
}  // namespace vat::test::session_grab_test
