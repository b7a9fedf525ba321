// What the participants of a session see of each other, and who holds what.

#include <thread>

#include "tests/server/session_fixture.h"

namespace vat::test::session_presence_test {
namespace {

using namespace std::chrono_literals;

constexpr BodyId kCube = 2;
constexpr BodyId kBall = 3;

ServerLimits short_grabs() {
  ServerLimits limits;
  limits.grab_idle = 700ms;
  limits.resume_time = 1h;
  return limits;
}

class Presence : public SessionTest {
 protected:
  using SessionTest::SessionTest;

  static std::uint64_t grab(TestClient& client, BodyId body) {
    const Json params = {{"body", body}, {"particle", 0}, {"target", {0.5, 0.5, 0.9}}};
    return client.result("grab.start", params).at("grab");
  }
  /// Waits until `client` is told of this participant as `fits` wants it.
  static Json wait_for(TestClient& client, std::uint64_t number,
                       const std::function<bool(const Json&)>& fits) {
    Json seen;
    client.wait_event("presence.changed", [&](const Json& params) {
      for (const Json& entry : params.at("participants")) {
        if (entry.at("participant") == number && fits(entry)) seen = entry;
      }
      return !seen.is_null();
    });
    return seen;
  }
  static bool always(const Json&) { return true; }
};

class IdleGrabs : public Presence {
 protected:
  IdleGrabs() : Presence(short_grabs()) {}
};

TEST_F(Presence, WhoComesIsToldOfThoseThereAndTheyOfIt) {
  const auto guest = connect();
  const Json joined = guest->result("session.join", {{"name", "Ada"}});
  const std::uint64_t number = joined.at("participant");
  ASSERT_EQ(joined.at("participants").size(), 2u);
  EXPECT_EQ(joined.at("participants").at(0).at("participant"), 1);
  const Json expected = {{"participant", number}, {"name", "Ada"},          {"role", "controller"},
                         {"away", false},         {"grabs", Json::array()}, {"pointer", nullptr}};
  EXPECT_EQ(joined.at("participants").at(1), expected);
  EXPECT_EQ(wait_for(*client, number, always), expected);
  EXPECT_EQ(client->result("presence.list").at("participants").at(1), expected);
}

TEST_F(Presence, TellsWhoIsAwayAndWhoHasGone) {
  auto guest = connect();
  const Json joined = guest->result("session.join");
  const std::uint64_t number = joined.at("participant");
  guest->disconnect();
  wait_for(*client, number, [](const Json& entry) { return entry.at("away") == true; });
  guest = connect();
  guest->result("session.join", {{"resume", joined.at("resume")}});
  wait_for(*client, number, [](const Json& entry) { return entry.at("away") == false; });
  guest->result("session.leave");
  client->wait_event("presence.changed",
                     [&](const Json& params) { return params.at("left") == Json({number}); });
}

TEST_F(Presence, TellsNamesRolesAndWhatIsHeld) {
  const auto guest = connect();
  const std::uint64_t number = guest->result("session.join").at("participant");
  guest->result("participant.rename", {{"name", "Bob"}});
  wait_for(*client, number, [](const Json& entry) { return entry.at("name") == "Bob"; });
  const std::uint64_t first = grab(*guest, kBall);
  grab(*guest, kBall);
  grab(*guest, kCube);
  wait_for(*client, number, [](const Json& entry) {
    return entry.at("grabs") == Json({kCube, kBall});
  });
  guest->result("grab.end", {{"grab", first}});
  client->result("world.remove_body", {{"body", kCube}});
  wait_for(*client, number, [](const Json& entry) { return entry.at("grabs") == Json({kBall}); });
  const auto admin = connect_admin();
  admin->result("session.join");
  admin->result("participant.set_role", {{"participant", number}, {"role", "viewer"}});
  wait_for(*client, number, [](const Json& entry) {
    return entry.at("role") == "viewer" && entry.at("grabs").empty();
  });
}

TEST_F(Presence, TellsWhereSomebodyPoints) {
  const auto guest = connect();
  const std::uint64_t number = guest->result("session.join").at("participant");
  const Json place = {{"position", {1, 2, 3}}};
  guest->result("presence.point", place);
  wait_for(*client, number, [&](const Json& entry) { return entry.at("pointer") == place; });
  const Json ray = {{"position", {1, 2, 3}}, {"direction", {0, 0, -1}}};
  guest->result("presence.point", ray);
  wait_for(*client, number, [&](const Json& entry) { return entry.at("pointer") == ray; });
  guest->result("presence.point");
  wait_for(*client, number, [](const Json& entry) { return entry.at("pointer").is_null(); });
  EXPECT_EQ(guest->error("presence.point", {{"direction", {0, 0, 1}}}).at("data").at("path"),
            "/position");
}

// The session pauses: nothing but the pointer makes it work.
TEST_F(Presence, IsToldTenTimesASecondAtMostAndTheLastAlways) {
  const auto guest = connect();
  const std::uint64_t number = guest->result("session.join").at("participant");
  client->mark();
  const auto begin = std::chrono::steady_clock::now();
  const int moves = 500;
  for (int i = 1; i <= moves; ++i) guest->result("presence.point", {{"position", {i, 0, 0}}});
  wait_for(*client, number, [&](const Json& entry) {
    return entry.at("pointer") == Json({{"position", {moves, 0, 0}}});
  });
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  const auto told = static_cast<double>(client->events("presence.changed").size());
  EXPECT_LE(told, time.count() / 0.1 + 1);
}

TEST_F(Presence, TellsOfAHundredAtMost) {
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
  const std::uint64_t first = grab(*guest, kBall);
  const std::uint64_t second = grab(*guest, kBall);
  const Json params = {{"body", kBall}, {"particle", 0}, {"target", {0.5, 0.5, 0.9}}};
  const Json error = client->error("grab.start", params);
  EXPECT_EQ(error.at("code"), 1008);
  EXPECT_EQ(error.at("data").at("kind"), "busy");
  EXPECT_EQ(error.at("data").at("holder"), Json({{"participant", 2}, {"name", "Ada"}}));
  grab(*client, kCube);
  guest->result("grab.end", {{"grab", first}});
  EXPECT_EQ(client->error("grab.start", params).at("code"), 1008) << "by another finger";
  guest->result("grab.end", {{"grab", second}});
  grab(*client, kBall);
}

TEST_F(IdleGrabs, EndAndThoseThatMoveDoNot) {
  const auto guest = connect();
  const std::uint64_t number = guest->result("session.join").at("participant");
  const std::uint64_t idle = grab(*guest, kCube);
  const std::uint64_t used = grab(*guest, kBall);
  // Moved every tenth of what a grab may idle, for longer than the ends come late.
  for (int i = 0; i < 25; ++i) {
    std::this_thread::sleep_for(70ms);
    guest->result("grab.move", {{"grab", used}, {"target", {0.5, 0.5, 0.8}}});
  }
  const Json event = client->wait_event("grab.ended");
  EXPECT_EQ(event,
            Json({{"grab", idle}, {"body", kCube}, {"participant", number}, {"reason", "idle"}}));
  EXPECT_EQ(client->events("grab.ended").size(), 1u);
  EXPECT_EQ(guest->error("grab.end", {{"grab", idle}}).at("code"), -32602);
  grab(*client, kCube);
  guest->result("grab.end", {{"grab", used}});
}

TEST_F(IdleGrabs, EndWhileTheirParticipantIsAway) {
  const auto guest = connect();
  guest->result("session.join");
  const std::uint64_t held = grab(*guest, kBall);
  guest->disconnect();
  EXPECT_EQ(client->wait_event("grab.ended").at("grab"), held);
  grab(*client, kBall);
}

}  // namespace
}  // namespace vat::test::session_presence_test
