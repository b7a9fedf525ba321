// Presence: the information that participants receive about one another, and their grabs.

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_presence_test {
namespace {

using namespace std::chrono_literals;

constexpr BodyId kCube = 2;
constexpr BodyId kBall = 3;

ServerLimits short_grabs() {
  ServerLimits limits;
  limits.grab_idle = 10s;
  limits.resume_time = 1h;
  return limits;
}

class Presence : public SessionTest {
 protected:
  using SessionTest::SessionTest;

  /// Waits until the client receives data of this participant with these members.
  Json wait_for(std::uint64_t number, const Json& members = Json::object()) {
    Json seen;
    client->wait_event("presence.changed", [&](const Json& params) {
      for (const Json& entry : params.at("participants")) {
        Json expected = entry;
        expected.update(members);
        if (entry.at("participant") == number && entry == expected) seen = entry;
      }
      return !seen.is_null();
    });
    return seen;
  }
};

class IdleGrabs : public Presence {
 protected:
  IdleGrabs() : Presence(short_grabs()) {}
};

TEST_F(Presence, NewcomersAndOthersReceiveEachOther) {
  const auto guest = connect();
  const Json joined = guest->result("session.join", {{"name", "Ada"}});
  const std::uint64_t number = joined.at("participant");
  ASSERT_EQ(joined.at("participants").size(), 2u);
  EXPECT_EQ(joined.at("participants").at(0).at("participant"), 1);
  const Json expected = {{"participant", number}, {"name", "Ada"},          {"role", "controller"},
                         {"away", false},         {"grabs", Json::array()}, {"pointer", nullptr}};
  EXPECT_EQ(joined.at("participants").at(1), expected);
  EXPECT_EQ(wait_for(number), expected);
  EXPECT_EQ(client->result("presence.list").at("participants").at(1), expected);
}

TEST_F(Presence, HasAbsentAndFormerParticipants) {
  auto guest = connect();
  const Json joined = guest->result("session.join");
  const std::uint64_t number = joined.at("participant");
  guest->disconnect();
  wait_for(number, {{"away", true}});
  guest = connect();
  guest->result("session.join", {{"resume", joined.at("resume")}});
  wait_for(number, {{"away", false}});
  guest->result("session.leave");
  client->wait_event("presence.changed",
                     [&](const Json& params) { return params.at("left") == Json({number}); });
}

TEST_F(Presence, HasNamesRolesAndGrabs) {
  const auto guest = connect();
  const std::uint64_t number = guest->result("session.join").at("participant");
  guest->result("participant.rename", {{"name", "Bob"}});
  wait_for(number, {{"name", "Bob"}});
  const std::uint64_t first = guest->grab(kBall);
  guest->grab(kBall);
  guest->grab(kCube);
  wait_for(number, {{"grabs", {kCube, kBall}}});
  guest->result("grab.end", {{"grab", first}});
  client->result("world.remove_body", {{"body", kCube}});
  wait_for(number, {{"grabs", Json::array({kBall})}});
  const auto admin = connect_admin();
  admin->result("session.join");
  admin->result("participant.set_role", {{"participant", number}, {"role", "viewer"}});
  client->grab(kBall);
  wait_for(number, {{"role", "viewer"}, {"grabs", Json::array()}});
}

TEST_F(Presence, HasPointers) {
  const auto guest = connect();
  const std::uint64_t number = guest->result("session.join").at("participant");
  const Json place = {{"position", {1, 2, 3}}};
  guest->result("presence.point", place);
  wait_for(number, {{"pointer", place}});
  const Json ray = {{"position", {1, 2, 3}}, {"direction", {0, 0, -1}}};
  guest->result("presence.point", ray);
  wait_for(number, {{"pointer", ray}});
  guest->result("presence.point");
  wait_for(number, {{"pointer", nullptr}});
  EXPECT_EQ(guest->error("presence.point", {{"direction", {0, 0, 1}}}).at("data").at("path"),
            "/position");
}

// The session is paused, so only the pointer causes work.
TEST_F(Presence, IsSentTenTimesASecondAtMostAndTheLastAlways) {
  const auto guest = connect();
  const std::uint64_t number = guest->result("session.join").at("participant");
  server.clock().advance(250ms);
  client->mark();
  constexpr int kMoves = 50;
  for (int i = 1; i <= kMoves; ++i) guest->result("presence.point", {{"position", {i, 0, 0}}});
  EXPECT_EQ(client->events("presence.changed").size(), 1u);
  server.clock().advance(99ms);
  EXPECT_EQ(client->events("presence.changed").size(), 1u);
  server.clock().advance(1ms);
  EXPECT_EQ(client->events("presence.changed").size(), 2u);
  wait_for(number, {{"pointer", {{"position", {kMoves, 0, 0}}}}});
  server.clock().advance(1s);
  EXPECT_EQ(client->events("presence.changed").size(), 2u);
}

TEST_F(Presence, HasAHundredParticipantsAtMost) {
  std::vector<std::unique_ptr<TestClient>> guests;
  for (int i = 0; i < 101; ++i) guests.push_back(join());
  const Json list = client->result("presence.list").at("participants");
  ASSERT_EQ(list.size(), 100u);
  EXPECT_EQ(list.at(99).at("participant"), 100);
  EXPECT_EQ(client->result("server.info").at("limits").at("presence"), 100);
}

TEST_F(Presence, ABodyIsHeldByOneAtATime) {
  const auto guest = connect();
  guest->result("session.join", {{"name", "Ada"}});
  const std::uint64_t first = guest->grab(kBall);
  const std::uint64_t second = guest->grab(kBall);
  const Json params = {{"body", kBall}, {"particle", 0}, {"target", {0.5, 0.5, 0.9}}};
  const Json error = client->error("grab.start", params);
  EXPECT_EQ(error.at("code"), 1008);
  EXPECT_EQ(error.at("data").at("kind"), "busy");
  EXPECT_EQ(error.at("data").at("holder"), Json({{"participant", 2}, {"name", "Ada"}}));
  client->grab(kCube);
  guest->result("grab.end", {{"grab", first}});
  EXPECT_EQ(client->error("grab.start", params).at("code"), 1008)
      << "another grab of the same client";
  guest->result("grab.end", {{"grab", second}});
  client->grab(kBall);
}

TEST_F(IdleGrabs, EndAndThoseThatMoveDoNot) {
  const auto guest = connect();
  const std::uint64_t number = guest->result("session.join").at("participant");
  const std::uint64_t idle = guest->grab(kCube);
  const std::uint64_t used = guest->grab(kBall);
  server.clock().advance(9500ms);
  EXPECT_TRUE(client->events("grab.ended").empty());
  guest->result("grab.move", {{"grab", used}, {"target", {0.5, 0.5, 0.8}}});
  server.clock().advance(1s);
  const std::vector<Json> ended = client->events("grab.ended");
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0],
            Json({{"grab", idle}, {"body", kCube}, {"participant", number}, {"reason", "idle"}}));
  server.clock().advance(8s);
  EXPECT_EQ(client->events("grab.ended").size(), 1u);
  EXPECT_EQ(guest->error("grab.end", {{"grab", idle}}).at("code"), -32602);
  client->grab(kCube);
  guest->result("grab.end", {{"grab", used}});
}

TEST_F(IdleGrabs, EndWhileTheirParticipantIsAway) {
  const auto guest = connect();
  guest->result("session.join");
  const std::uint64_t held = guest->grab(kBall);
  guest->disconnect();
  server.clock().advance(10500ms);
  ASSERT_EQ(client->events("grab.ended").size(), 1u);
  EXPECT_EQ(client->events("grab.ended")[0].at("grab"), held);
  client->grab(kBall);
}

}  // namespace
}  // namespace vat::test::session_presence_test
