// The governor of a session: permission, switches, their log entries, replay and recovery.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
    const std::string own = client->create_session();
    EXPECT_EQ(client->result("session.join", {{"session", own}}).at("role"), "owner");
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
  EXPECT_EQ(client->result("session.configure", {{"locked", true}}).at("governor"), points());
  client->result("session.configure", {{"governor", Json::array()}});
  EXPECT_FALSE(fall_behind()) << "the owner has ended the permission";
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

TEST_F(GovernorReplayTest, ReplaysRepeatTheSwitchesWithoutAGovernor) {
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

  const Json opened = client_->result("replay.open", {{"session", "s1"}});
  client_->result("session.join", {{"session", opened.at("session")}});
  const Json error = client_->error("session.configure", {{"governor", points()}});
  EXPECT_THAT(error.at("message").get<std::string>(), HasSubstr("a replay has no governor"));
}

using GovernorRecoveryTest = SessionRecoveryTest;

TEST_F(GovernorRecoveryTest, ARecoveredSessionContinuesAtItsPoint) {
  begin();
  Json place{{"session", client().create_session()}};
  place["resume"] = client().result("session.join", place).at("resume");
  client().result("session.configure", {{"governor", points()}});
  ASSERT_TRUE(fall_behind(clock, client(), [&] { life->server.flush(); }));
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

// The rules by which the governor chooses among the points of a front.

using Choice = std::optional<std::size_t>;

const std::vector<GovernorPoint> kPoints{
    {{.step = 1e-3}, 1e-4, 0.8}, {{.step = 2e-3}, 1e-3, 0.4}, {{.step = 4e-3}, 1e-2, 0.2}};
constexpr double kInterval = 0.5;

/// A session that follows the governor.
class GovernorTest : public testing::Test {
 protected:
  /// Returns the seconds until the governor changes the point, or nothing after `most` seconds.
  std::optional<double> run(bool is_behind, double load, double most = 10'000) {
    for (double time = kInterval; time <= most; time += kInterval) {
      const Choice choice = governor.add({kInterval, is_behind, load}, point, kPoints);
      if (!choice) continue;
      point = *choice;
      return time;
    }
    return {};
  }
  std::optional<double> fall_behind(double most = 10'000) { return run(true, 1.2, most); }

  Governor governor;
  std::size_t point = 0;
};

TEST_F(GovernorTest, UsesTheNextCheaperPointAfterSecondsOfDelay) {
  EXPECT_EQ(fall_behind(), Governor::kBehindSeconds);
  EXPECT_EQ(point, 1u);
  EXPECT_EQ(fall_behind(), Governor::kBehindSeconds);
  EXPECT_EQ(point, 2u);
  EXPECT_FALSE(fall_behind()) << "there is no cheaper point";
}

TEST_F(GovernorTest, ShortDelaysChangeNothing) {
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(fall_behind(Governor::kBehindSeconds - kInterval));
    EXPECT_FALSE(run(false, 0.9, kInterval));
  }
  EXPECT_FALSE(fall_behind(Governor::kBehindSeconds - kInterval));
  governor.restart();
  EXPECT_EQ(fall_behind(), Governor::kBehindSeconds) << "delays before a pause do not count";
}

TEST_F(GovernorTest, ReturnsIfThePredictedLoadLeavesAFifthFree) {
  point = 2;
  EXPECT_FALSE(run(false, 0.41)) << "the more accurate point takes twice the time";
  EXPECT_EQ(run(false, 0.39), Governor::kReserveSeconds);
  EXPECT_EQ(point, 1u);
  EXPECT_EQ(run(false, 0.39), Governor::kReserveSeconds);
  EXPECT_EQ(point, 0u);
  EXPECT_FALSE(run(false, 0.1)) << "there is no more accurate point";
}

TEST_F(GovernorTest, AGreaterLoadRestartsTheTimeOfTheReserve) {
  point = 1;
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(run(false, 0.1, Governor::kReserveSeconds - kInterval));
    EXPECT_FALSE(run(false, 0.5, kInterval));
  }
  EXPECT_EQ(run(false, 0.1), Governor::kReserveSeconds);
}

TEST_F(GovernorTest, FailedPointsWaitTwiceAsLongAfterEachFailure) {
  fall_behind();
  ASSERT_EQ(point, 1u);
  ASSERT_EQ(run(false, 0.1), Governor::kReserveSeconds);
  double wait = Governor::kLeastWait;
  for (int failure = 0; failure < 12; ++failure) {
    ASSERT_EQ(point, 0u);
    ASSERT_EQ(fall_behind(), Governor::kBehindSeconds);
    EXPECT_EQ(run(false, 0.1), std::max(wait, Governor::kReserveSeconds)) << failure;
    wait = std::min(2 * wait, Governor::kMostWait);
  }
}

TEST_F(GovernorTest, APointThatPassesItsTrialHasNoFailures) {
  fall_behind();
  run(false, 0.1);
  fall_behind();  // point 0 fails
  ASSERT_EQ(run(false, 0.1), Governor::kLeastWait);
  ASSERT_FALSE(run(false, 0.1, Governor::kTrialSeconds));
  ASSERT_EQ(fall_behind(), Governor::kBehindSeconds) << "no failure, since the trial has ended";
  EXPECT_EQ(run(false, 0.1), Governor::kReserveSeconds);
  fall_behind();
  EXPECT_EQ(run(false, 0.1), Governor::kLeastWait) << "the first failure again";
}

TEST_F(GovernorTest, AChangeByAParticipantStartsNoTrial) {
  point = 1;
  ASSERT_FALSE(run(false, 0.5, 20));
  point = 0;
  ASSERT_EQ(fall_behind(), Governor::kBehindSeconds);
  EXPECT_EQ(run(false, 0.1), Governor::kReserveSeconds);
}

TEST_F(GovernorTest, SkipsAPointThatTheSessionCannotUse) {
  governor.fail(1);
  EXPECT_EQ(fall_behind(), Governor::kBehindSeconds);
  EXPECT_EQ(point, 2u);
}

TEST_F(GovernorTest, TriesAPointAgainAfterARefusal) {
  ASSERT_EQ(fall_behind(), Governor::kBehindSeconds);
  ASSERT_EQ(fall_behind(), Governor::kBehindSeconds);
  ASSERT_EQ(point, 2u);
  point = 1;
  governor.fail(2);  // the command was refused
  EXPECT_EQ(fall_behind(), Governor::kLeastWait);
  EXPECT_EQ(point, 2u);
}

}  // namespace
}  // namespace vat::test::session_governor_test
