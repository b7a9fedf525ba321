// The governor of a session: permission, switches, their log entries, replay and recovery.

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "server/session/ticks/governor.h"
#include "tests/server/replay/replay_fixture.h"
#include "tests/server/session/recovery_fixture.h"

namespace vat::test::session_governor_test {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr double kOwnStep = 0.002;
constexpr double kLongStep = 0.0025;
constexpr auto kTickWithDelay = 200ms;  // ten times the period

Json point(double step, double error, double seconds) {
  return {
      {"integrator", "velocity_verlet"}, {"step", step}, {"error", error}, {"seconds", seconds}};
}

/// The numerics of the scene, and cheaper ones.
Json points() {
  Json own = point(kOwnStep, 0.001, 0.5);
  own["control"] = "fixed";
  Json cheaper = point(kLongStep, 0.01, 0.4);
  cheaper["control"] = "adaptive";
  cheaper["tolerance"] = 0.05;
  return Json::array({own, cheaper});
}

Json numerics_of(TestClient& client) {
  return client.result("scene.get", {{"current", true}}).at("scene").at("numerics");
}
double step_of(TestClient& client) {
  return numerics_of(client).at("step");
}

/// Runs a playing session behind its requested speed for `time`, or until the governor switches.
/// `flush` waits for writes of the server.
template <class Flush>
bool fall_behind(ManualClock& clock, TestClient& client, Flush flush,
                 std::chrono::milliseconds time = 20s) {
  client.mark();
  for (auto passed = 0ms; passed < time; passed += kTickWithDelay) {
    clock.expire(kTickWithDelay);
    clock.advance(0ms);
    flush();
    clock.advance(0ms);
    if (!client.events("governor.switched").empty()) return true;
  }
  return false;
}

/// Pauses a stored session, which executes the command before its next tick.
void pause(TestClient& client) {
  client.wait_reply_at_tick(client.send("control.pause"));
}

class SessionGovernorTest : public SessionTest {
 protected:
  void SetUp() override {
    const Json made = client->result("session.create", {{"name", "own"}, {"scene", "mixed"}});
    own_ = made.at("session");
    EXPECT_EQ(client->result("session.join", {{"session", own_}}).at("role"), "owner");
  }
  bool fall_behind(std::chrono::milliseconds time = 20s) {
    return session_governor_test::fall_behind(
        server.clock(), *client, [] {}, time);
  }
  /// Returns the paths of the errors of session.configure.
  std::vector<std::string> errors_of(const Json& governor) {
    const Json error = client->error("session.configure", {{"governor", governor}});
    std::vector<std::string> paths;
    for (const Json& one : error.at("data").at("errors")) paths.push_back(one.at("path"));
    return paths;
  }

  std::string own_;
};

TEST_F(SessionGovernorTest, SwitchesToTheCheaperPointAndBack) {
  EXPECT_EQ(client->result("session.configure", {{"governor", points()}}).at("governor"), points());
  ASSERT_TRUE(fall_behind());
  const Json cheaper = client->events("governor.switched").at(0);
  EXPECT_EQ(cheaper.at("point"), 1);
  EXPECT_EQ(cheaper.at("error"), 0.01);
  EXPECT_EQ(cheaper.at("reason"), "behind");
  EXPECT_EQ(step_of(*client), kLongStep);
  EXPECT_EQ(numerics_of(*client).at("control"), "adaptive");
  EXPECT_EQ(numerics_of(*client).at("tolerance"), 0.05);
  const auto is_cheaper = [](const Json& status) { return status.at("governor").at("point") == 1; };
  EXPECT_EQ(client->wait_event("session.status", is_cheaper).at("governor").at("error"), 0.01);
  client->mark();
  const auto begin = server.clock().now();
  const Json back = client->wait_event("governor.switched");
  EXPECT_EQ(back.at("point"), 0);
  EXPECT_EQ(back.at("error"), 0.001);
  EXPECT_EQ(back.at("reason"), "reserve");
  EXPECT_GE(server.clock().now() - begin, std::chrono::duration<double>(Governor::kReserveSeconds));
  EXPECT_EQ(step_of(*client), kOwnStep);
  EXPECT_EQ(numerics_of(*client).at("control"), "fixed");
}

TEST_F(SessionGovernorTest, DoesNothingWithoutPermission) {
  EXPECT_FALSE(client->result("session.configure").contains("governor"));
  EXPECT_FALSE(fall_behind());
  EXPECT_EQ(step_of(*client), kOwnStep);
  const Json status = client->wait_event("session.status");
  EXPECT_LT(status.at("real_time_factor"), 0.9);
  EXPECT_FALSE(status.contains("governor"));
  client->result("session.configure", {{"governor", points()}});
  client->result("session.configure", {{"governor", Json::array()}});
  EXPECT_FALSE(fall_behind()) << "the owner has ended the permission";
}

TEST_F(SessionGovernorTest, OnlyTheOwnerPermitsIt) {
  const auto other = join(own_);
  const Json error = other->error("session.configure", {{"governor", points()}});
  EXPECT_EQ(error.at("code"), 1006);
  EXPECT_EQ(error.at("data").at("role"), "controller");
}

TEST_F(SessionGovernorTest, OtherSettingsKeepThePermission) {
  client->result("session.configure", {{"governor", points()}});
  EXPECT_EQ(client->result("session.configure", {{"locked", true}}).at("governor"), points());
}

TEST_F(SessionGovernorTest, ALoadOfASceneEndsThePermission) {
  client->result("session.configure", {{"governor", points()}});
  client->mark();
  client->result("scene.load", {{"scene", "mixed"}});
  EXPECT_FALSE(client->wait_event("session.configured").contains("governor"));
  EXPECT_FALSE(client->result("session.configure").contains("governor"));
  EXPECT_FALSE(fall_behind());
}

TEST_F(SessionGovernorTest, AResetReturnsToTheLoadedPoint) {
  client->result("session.configure", {{"governor", points()}});
  ASSERT_TRUE(fall_behind());
  client->result("control.reset");
  EXPECT_EQ(step_of(*client), kOwnStep);
  EXPECT_TRUE(fall_behind()) << "the permission is for the scene";
}

TEST_F(SessionGovernorTest, NumericsOfAParticipantSuspendIt) {
  client->result("session.configure", {{"governor", points()}});
  client->result("world.set_numerics", {{"integrator", "heun"}});
  EXPECT_FALSE(fall_behind());
  client->result("world.set_numerics", {{"integrator", "velocity_verlet"}});
  EXPECT_TRUE(fall_behind());
}

TEST_F(SessionGovernorTest, APauseIsNoDelay) {
  client->result("session.configure", {{"governor", points()}});
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(fall_behind(2s));
    client->result("control.pause");
    server.clock().advance(2s);
    client->result("control.play");
  }
}

TEST_F(SessionGovernorTest, InvalidPointsAreNamed) {
  using Paths = std::vector<std::string>;
  const Json own = point(kOwnStep, 0.001, 0.5);
  EXPECT_EQ(errors_of(Json::array({own})), Paths{"/governor"});
  EXPECT_EQ(errors_of(Json::array({own, point(kLongStep, 0.001, 0.4)})),
            Paths{"/governor/1/error"});
  EXPECT_EQ(errors_of(Json::array({own, point(kLongStep, 0.01, 0.5)})),
            Paths{"/governor/1/seconds"});
  EXPECT_EQ(errors_of(Json::array({own, point(0, 0.01, 0.4)})), Paths{"/governor/1/step"});
  EXPECT_EQ(errors_of(Json::array({own, point(0.003, 0.01, 0.4)})), Paths{"/governor/1/step"})
      << "a tick has no whole number of these steps";
  EXPECT_EQ(errors_of(Json::array({point(0.001, 0.001, 0.5), point(kLongStep, 0.01, 0.4)})),
            Paths{"/governor"})
      << "the session uses neither point";
  Json other = point(kLongStep, 0.01, 0.4);
  other["tick"] = 0.01;
  EXPECT_EQ(errors_of(Json::array({own, other})), Paths{"/governor/1/tick"});
  EXPECT_EQ(errors_of(Json::array({own, point(kOwnStep, 0.01, 0.4)})), Paths{"/governor/1"});
  EXPECT_EQ(errors_of(Json::array({own, {{"error", 0.01}, {"seconds", 0.4}}})),
            Paths{"/governor/1"});
  Json many = Json::array();
  for (std::size_t i = 0; i <= kMaxGovernorPoints; ++i) {
    const auto steps = static_cast<double>(10 + kMaxGovernorPoints - i);
    many.push_back(point(0.02 / steps, static_cast<double>(i), steps));
  }
  EXPECT_EQ(errors_of(many), Paths{"/governor"});
  many.erase(0);
  EXPECT_EQ(client->result("session.configure", {{"governor", many}}).at("governor"), many);
}

using GovernorReplayTest = ReplayTest;

TEST_F(GovernorReplayTest, ReplaysRepeatTheSwitches) {
  client_->result("access.enter", {{"token", kAdminToken}});
  client_->result("session.join", {{"session", "s1"}});
  client_->result("session.configure", {{"governor", points()}});
  client_->result("control.play");
  ASSERT_TRUE(fall_behind(server_.clock(), *client_, [&] { server_.flush(); }));
  client_->mark();
  EXPECT_EQ(client_->wait_event("governor.switched").at("reason"), "reserve");
  pause(*client_);
  step(3);
  const Recording recording = record();
  const auto is_switch = [](const LogEntry& entry) {
    return entry.method == "world.set_numerics" && entry.participant == kServerItself;
  };
  EXPECT_EQ(std::ranges::count_if(recording.log, is_switch), 2);
  Replay replay(recording, environment_);
  replay.player.play_to(replay.core, recording.end, kGoOn);
  EXPECT_EQ(replay.hash(), live_hash());
  EXPECT_GT(replay.compared, 0U);
}

TEST_F(GovernorReplayTest, AReplayHasNoGovernor) {
  client_->result("access.enter", {{"token", kAdminToken}});
  const Json opened = client_->result("replay.open", {{"session", "s1"}});
  client_->result("session.join", {{"session", opened.at("session")}});
  const Json error = client_->error("session.configure", {{"governor", points()}});
  EXPECT_THAT(error.at("message").get<std::string>(), HasSubstr("a replay has no governor"));
}

using GovernorRecoveryTest = SessionRecoveryTest;

TEST_F(GovernorRecoveryTest, ARecoveredSessionContinuesAtItsPoint) {
  begin();
  const Json made = client().result("session.create", {{"name", "own"}, {"scene", "mixed"}});
  Json place{{"session", made.at("session")}};
  place["resume"] = client().result("session.join", place).at("resume");
  client().result("session.configure", {{"governor", points()}});
  ASSERT_TRUE(fall_behind(clock, client(), [&] { life->flush(); }));
  pause(client());
  const std::string before = life->hash();
  clock.advance(1s);  // time after which the present participants are stored
  crash();
  const Json joined = client().result("session.join", place);
  EXPECT_EQ(joined.at("settings").at("governor"), points());
  EXPECT_TRUE(client().events("session.diverged").empty());
  EXPECT_EQ(life->hash(), before);
  EXPECT_EQ(step_of(client()), kLongStep);
  client().mark();
  client().result("control.play");
  EXPECT_EQ(client().wait_event("governor.switched").at("point"), 0);
  pause(client());
  const std::string later = life->hash();
  crash();
  client().result("session.join", place);
  EXPECT_EQ(life->hash(), later);
  EXPECT_EQ(step_of(client()), kOwnStep);
}

}  // namespace
}  // namespace vat::test::session_governor_test
