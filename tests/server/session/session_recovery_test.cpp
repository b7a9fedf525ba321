// Recovery of sessions after a crash.

#include "core/simulation/simulation.h"
#include "tests/server/session/recovery_fixture.h"
#include "tests/support/wait.h"

namespace vat::test::session_recovery_test {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

const Json kBall = wooden_ball("second");

TEST_F(SessionRecoveryTest, CommandsAndTicksThatWereAnsweredAreThere) {
  begin();
  client().result("control.pause");
  client().result("control.reset");
  client().result("control.step", {{"ticks", 7}});
  client().result("world.set_gravity", {{"gravity", {1, 0, -9}}});
  client().result("world.add_body", {{"body", kBall}});
  client().result("control.step", {{"ticks", 5}});
  client().result("world.set_interface",
                  {{"interface", {{"materials", {"wood", "wood"}}, {"stiffness", 500}}}});
  client().result("world.apply_force", {{"body", 3}, {"force", {0, 5, 0}}, {"duration", 1}});
  client().result("control.step", {{"ticks", 3}});
  const std::string before = life->hash();
  const int epoch = life->joined.at("description").at("epoch");
  crash();
  EXPECT_EQ(life->recovered, 1U);
  EXPECT_EQ(life->tick(), 15U);
  EXPECT_EQ(life->hash(), before);
  EXPECT_FALSE(life->joined.at("description").at("playing"));
  EXPECT_EQ(life->joined.at("description").at("name"), "first");
  EXPECT_GT(life->joined.at("description").at("epoch"), epoch);
  EXPECT_TRUE(client().events("session.diverged").empty());
  // The session continues without a difference.
  client().result("control.step", {{"ticks", 4}});
  const std::string later = life->hash();
  crash();
  EXPECT_EQ(life->hash(), later);
}

TEST_F(SessionRecoveryTest, AResetGoesToTheSceneAndOnFromThere) {
  begin();
  client().result("control.pause");
  client().result("control.reset");
  const std::string start = life->hash();
  client().result("scene.load", {{"scene", "mixed"}});
  client().result("world.remove_body", {{"body", 2}});
  client().result("control.step", {{"ticks", 20}});
  crash();
  EXPECT_EQ(life->tick(), 20U);
  client().result("control.reset");
  EXPECT_EQ(life->hash(), start);
  client().result("control.step", {{"ticks", 3}});
  const std::string later = life->hash();
  crash();
  EXPECT_EQ(life->tick(), 3U);
  EXPECT_EQ(life->hash(), later);
}

// The log contains the scene at its normal level, and the level.
TEST_F(SessionRecoveryTest, ALoadedSceneKeepsItsLevel) {
  const Json scene = Json::parse(R"({"format": "vat.scene/1", "name": "block",
      "materials": [{"name": "wood"}],
      "bodies": [{"name": "block", "kind": "rigid", "material": "wood", "spacing": 0.1,
                  "shape": {"type": "box", "size": [0.6, 0.6, 0.6]}}]})");
  begin();
  client().result("control.pause");
  client().result("scene.load", {{"scene", scene}, {"level", "coarse"}});
  client().result("control.step", {{"ticks", 3}});
  const std::string before = life->hash();
  crash();
  EXPECT_EQ(life->hash(), before);
  client().result("control.reset");
  const Json described = client().result("session.join").at("description");
  EXPECT_EQ(described.at("scene"), "block");
  EXPECT_EQ(described.at("level"), "coarse");
  EXPECT_EQ(described.at("bodies").at(0).at("particles"), 64);
}

TEST_F(SessionRecoveryTest, GrabsEndWithoutAResume) {
  ServerLimits impatient;
  impatient.resume_time = 0ms;
  begin();
  client().result("control.pause");
  client().result("grab.start", {{"body", 3}, {"particle", 0}, {"target", {0.5, 0.5, 0.9}}});
  client().result("grab.move", {{"grab", 1}, {"target", {0.2, 0.5, 0.9}}});
  client().result("control.step", {{"ticks", 5}});
  const std::string held = life->hash();
  crash(impatient);
  EXPECT_TRUE(client().call("grab.move", {{"grab", 1}, {"target", {0, 0, 0}}}).contains("error"));
  clock.advance(500ms);  // to the next status
  EXPECT_NE(life->hash(), held) << "the grab still acts";
  const std::string free = life->hash();
  crash();
  EXPECT_EQ(life->hash(), free);
}

TEST_F(SessionRecoveryTest, RepeatsAcceptedAndRefusedCommands) {
  ServerLimits few;
  few.max_particles = mixed_simulation().particle_count() + 2;  // not enough for a second ball
  begin(few);
  client().result("control.pause");
  EXPECT_EQ(client().error("world.add_body", {{"body", kBall}}).at("data").at("kind"),
            "limit_reached");
  crash();  // without the limit
  client().result("control.reset");
  EXPECT_EQ(client().result("state.query").at("bodies").size(), 3U);
  const int id = client().result("world.add_body", {{"body", kBall}}).at("body");
  const std::string with = life->hash();
  crash(few);
  EXPECT_EQ(life->hash(), with);
  EXPECT_EQ(client().result("state.query", {{"bodies", {id}}}).at("bodies")[0].at("name"),
            "second");
}

TEST_F(SessionRecoveryTest, ACrashBetweenARefusalAndItsMarkIsNoDivergence) {
  begin();
  client().result("control.pause");
  client().result("control.step", {{"ticks", 3}});
  client().error("world.remove_body", {{"body", 99}});
  const std::string before = life->hash();
  execute("UPDATE log SET refused = 0");
  crash();
  EXPECT_TRUE(client().events("session.diverged").empty());
  EXPECT_EQ(life->hash(), before);
  // The entry is marked now, so others may follow it.
  client().result("control.step", {{"ticks", 2}});
  crash();
  EXPECT_TRUE(client().events("session.diverged").empty());
}

TEST_F(SessionRecoveryTest, ARefusalWithoutAMarkThatOthersCameBehindIsADivergence) {
  begin();
  client().result("control.pause");
  client().error("world.remove_body", {{"body", 99}});
  client().result("control.step", {{"ticks", 3}});
  client().result("world.set_gravity", {{"gravity", {1, 0, -9}}});
  execute("UPDATE log SET refused = 0");
  crash();
  client().wait_event("session.diverged");
}

TEST_F(SessionRecoveryTest, ASessionThatPlaysIsBackAtMostASecondEarlierAndPlays) {
  begin();
  client().result("control.set_speed", {{"speed", 2}});
  const std::uint64_t seen =
      client()
          .wait_event("session.status", [](const Json& s) { return s.at("tick") > 200; })
          .at("tick");  // two seconds
  crash();
  const Json& description = life->joined.at("description");
  EXPECT_TRUE(description.at("playing"));
  EXPECT_EQ(description.at("speed"), 2);
  EXPECT_GE(description.at("tick").get<std::uint64_t>() + 101, seen);  // a heartbeat and a tick
}

// Recovery skips the log before the newest checkpoint. This part may be damaged.
TEST_F(SessionRecoveryTest, CheckpointsSpareTheWayAndLeadToTheSame) {
  storage.checkpoint_after = 1ms;
  begin();
  client().result("control.pause");
  client().result("control.reset");
  for (int i = 0; i < 20; ++i) {
    client().result("control.step", {{"ticks", 10}});
    client().result("world.set_gravity", {{"gravity", {0, 0.1 * i, -9}}});
    life->server.flush();
  }
  const std::string before = life->hash();
  end_by_crash();
  execute("UPDATE log SET params = 'damaged' WHERE sequence BETWEEN 3 AND 5");
  begin();
  EXPECT_EQ(life->hash(), before);
  EXPECT_TRUE(client().events("session.diverged").empty());
  client().result("control.reset");
  crash();
  EXPECT_EQ(life->hash(), mixed_hash_after(0));
}

TEST_F(SessionRecoveryTest, ADamagedCheckpointIsPassedOver) {
  storage.checkpoint_after = 1ms;
  begin();
  client().result("control.pause");
  for (int i = 0; i < 5; ++i) client().result("control.step", {{"ticks", 10}});
  const std::string before = life->hash();
  life.reset();
  execute("UPDATE checkpoints SET state = CAST(substr(state, 1, 500) AS BLOB)", "/checkpoints.db");
  begin();
  EXPECT_EQ(life->hash(), before);
}

TEST_F(SessionRecoveryTest, ASessionRestoredInAnotherStateIsPausedAndReported) {
  begin();
  client().result("control.pause");
  client().result("control.step", {{"ticks", 10}});
  client().result("control.play");
  client().wait_event("session.status", [](const Json& s) { return s.at("tick") > 80; });
  life.reset();
  execute("DELETE FROM checkpoints", "/checkpoints.db");
  execute("UPDATE sessions SET hash = hash + 1");
  begin();
  const Json told = client().wait_event("session.diverged");
  EXPECT_NE(told.at("reason").get<std::string>().find("hash"), std::string::npos) << told;
  EXPECT_FALSE(life->joined.at("description").at("playing"));
  EXPECT_EQ(client().error("session.save", {{"name", "n"}}).at("data").at("kind"), "not_allowed");
  life.reset();  // no client has used the session
  begin();
  client().wait_event("session.diverged");
  client().result("control.reset");
  client().result("control.step", {{"ticks", 2}});
  const std::string after = life->hash();
  crash();  // the session continues from there
  EXPECT_EQ(life->hash(), after);
  EXPECT_TRUE(client().events("session.diverged").empty());
}

TEST_F(SessionRecoveryTest, ALostSessionStaysInItsFolderAndIsReported) {
  begin();
  client().result("control.pause");
  life.reset();
  execute("DELETE FROM checkpoints", "/checkpoints.db");
  execute("DELETE FROM log WHERE sequence = 1");
  const ServerSettings settings = test_settings({}, data);
  {
    TestServer server(catalogue, settings);
    EXPECT_EQ(server.recover(), 1U);
    ASSERT_TRUE(wait_until([&] { return server.is_ready(); }));
    TestClient visitor(server, 1);
    const Json sessions = visitor.result("session.list").at("sessions");
    ASSERT_EQ(sessions.size(), 1U);
    EXPECT_EQ(sessions[0].at("state"), "lost");
    EXPECT_EQ(sessions[0].at("name"), "first");
    const Json error = visitor.error("session.join", {{"session", "s1"}});
    EXPECT_EQ(error.at("code"), 1011);
    EXPECT_EQ(error.at("data").at("state"), "lost");
    EXPECT_EQ(visitor.error("replay.open", {{"session", "s1"}}).at("data").at("state"), "lost");
    const Json ticket = visitor.error("access.ticket", {{"session", "s1"}, {"role", "controller"}});
    EXPECT_EQ(ticket.at("data").at("state"), "lost");
    const Json refused = visitor.error("session.close", {{"session", "s1"}});
    EXPECT_EQ(refused.at("data").at("least_role"), "owner");
    EXPECT_EQ(visitor.result("session.list").at("sessions").size(), 1U);
  }
  TestServer server(catalogue, settings);
  EXPECT_EQ(server.recover(), 1U);
}

TEST_F(SessionRecoveryTest, DuringARecoveryTheServerReportsThatItIsNotReady) {
  begin();
  client().result("control.pause");
  client().result("control.step", {{"ticks", 1000}});
  life.reset();
  execute("DELETE FROM checkpoints", "/checkpoints.db");  // all ticks have to be repeated
  TestServer server(catalogue, test_settings({}, data));
  EXPECT_EQ(server.recover(), 1U);
  EXPECT_FALSE(server.is_ready());
  TestClient visitor(server, 1);
  EXPECT_EQ(visitor.result("session.list").at("sessions")[0].at("state"), "recovering");
  const Json error = visitor.error("replay.open", {{"session", "s1"}});
  EXPECT_EQ(error.at("code"), 1011);
  EXPECT_EQ(error.at("data").at("state"), "recovering");
  const int joining = visitor.send("session.join", {{"session", "s1"}});
  EXPECT_TRUE(wait_until([&] { return server.is_ready(); }));
  EXPECT_TRUE(visitor.wait_reply(joining).contains("result"));
}

TEST_F(SessionRecoveryTest, AClosedSessionStaysAwayAndANewOneGetsAnotherId) {
  begin();
  client().create_session();
  client().result("session.close", {{"session", "s2"}});
  crash();
  const Json sessions = client().result("session.list").at("sessions");
  ASSERT_EQ(sessions.size(), 1U);
  EXPECT_EQ(sessions[0].at("session"), "s1");
  EXPECT_EQ(client().create_session(), "s3");
}

TEST_F(SessionRecoveryTest, AResumedParticipantHasItsRoleGrabsAndFrames) {
  begin();
  const std::string own = client().create_session();
  const Json before = client().result("session.join", {{"session", own}, {"name", "Ada"}});
  EXPECT_EQ(before.at("role"), "owner");
  client().result("control.pause");
  client().result("session.configure", {{"name", "hers"}, {"locked", true}});
  const std::uint64_t grab = client().grab(3);
  client().result("frames.subscribe", {{"every", 7},
                                       {"detail", 2},
                                       {"region", {{"min", {0, 0, 0}}, {"max", {1, 1, 0.5}}}},
                                       {"attributes", {{"speed", 0.5}}}});
  clock.advance(1s);  // time after which the participants are stored, also of a paused session
  crash();
  const Json after =
      client().result("session.join", {{"session", own}, {"resume", before.at("resume")}});
  EXPECT_EQ(after.at("resumed"), true);
  EXPECT_EQ(after.at("participant"), before.at("participant"));
  EXPECT_EQ(after.at("name"), "Ada");
  EXPECT_EQ(after.at("role"), "owner");
  EXPECT_EQ(after.at("settings").at("locked"), true);
  EXPECT_EQ(after.at("settings").at("name"), "hers");
  const GridFrame frame = client().wait_frame([](const GridFrame&) { return true; });
  EXPECT_EQ(frame.detail, 2);
  EXPECT_TRUE(frame.has_region);
  EXPECT_DOUBLE_EQ(frame.scale.attribute_quanta[0], 1.0);
  client().result("grab.move", {{"grab", grab}, {"target", {0.5, 0.4, 0.9}}});
}

TEST_F(SessionRecoveryTest, AfterMuchWorkTheStateIsStored) {
  const auto checkpoints = [&] {
    return Database(data + "/checkpoints.db", Database::Mode::read)
        .number("SELECT count(*) FROM checkpoints");
  };
  storage.checkpoint_after = 1h;
  begin();
  client().result("control.pause");
  client().result("control.step", {{"ticks", 300}});  // needs much more than a millisecond
  clock.advance(1s);
  EXPECT_EQ(checkpoints(), 0);
  storage.checkpoint_after = 1ms;
  crash();
  client().result("world.set_gravity", {{"gravity", {0, 0, -9}}});
  clock.advance(1s);
  life->server.flush();
  EXPECT_GE(checkpoints(), 1) << "the work of the recovery counts";
}

// Recovery from recent states, which are not synchronised.

/// The budget admits one checkpoint. The later states are recent states.
class RecentState : public SessionRecoveryTest {
 protected:
  RecentState() {
    storage.checkpoint_after = 1ms;
    storage.checkpoint_bytes_per_second = 1;
    begin();
    client().result("control.pause");
    int commands = 0;
    const auto command = [&] {
      client().result("control.step", {{"ticks", 10}});
      client().result("world.set_gravity", {{"gravity", {0, 0.01 * ++commands, -9}}});
      life->server.flush();
      clock.advance(1s);
    };
    while (commands < 20) command();
    // A state is written after work that takes 20 times as long as the state, by measured times.
    const auto earlier = written();
    while (commands < 1000 && written() == earlier) command();
    before = life->hash();
    end_by_crash();
  }
  std::string file() const {
    for (const auto& entry : fs::directory_iterator(data + "/recent")) return entry.path();
    return {};
  }
  /// Returns the time at which the recent state was written.
  fs::file_time_type written() const {
    return file().empty() ? fs::file_time_type() : fs::last_write_time(file());
  }
  std::string before;
};

TEST_F(RecentState, IsTheStartOfARecovery) {
  const std::int64_t newest = Database(data + "/checkpoints.db", Database::Mode::read)
                                  .number("SELECT max(sequence) FROM checkpoints");
  ASSERT_LT(newest, 10);
  execute("UPDATE log SET params = 'damaged' WHERE sequence BETWEEN " + std::to_string(newest + 1) +
          " AND 10");
  begin();
  EXPECT_EQ(life->hash(), before);
  EXPECT_TRUE(client().events("session.diverged").empty());
}

TEST_F(RecentState, IsSkippedIfItIsIncomplete) {
  fs::resize_file(file(), fs::file_size(file()) / 2);
  begin();
  EXPECT_EQ(life->hash(), before);
}

// With durability "process", a power failure can lose the newest commands, and not the state.
TEST_F(RecentState, IsRemovedIfTheLogIsShorter) {
  execute("DELETE FROM log WHERE sequence > 8");
  execute("UPDATE sessions SET position = NULL, reached = 0");
  const std::int64_t tick =
      Database(data + "/vat.db", Database::Mode::read).number("SELECT max(tick) FROM log");
  begin();
  EXPECT_EQ(life->tick(), static_cast<std::uint64_t>(tick));
  EXPECT_TRUE(client().events("session.diverged").empty());
  client().result("control.step", {{"ticks", 3}});
  const std::string after = life->hash();
  crash();
  EXPECT_EQ(life->hash(), after);
}

}  // namespace
}  // namespace vat::test::session_recovery_test
