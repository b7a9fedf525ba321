// Sessions without clients hibernate after some time, and end after a longer time.

#include "tests/server/fixture/host.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::empty_session_test {
namespace {

using namespace std::chrono_literals;

constexpr auto kResumeTime = 2s;
constexpr auto kHibernateAfter = 10s;
constexpr auto kExpireAfter = 60s;
constexpr auto kStatusInterval = 500ms;  // of a session, which then also removes participants
constexpr auto kExpiryCheck = 15s;       // interval of the server's check of expired sessions

class EmptySession : public SessionTest {
 protected:
  explicit EmptySession(const ServerLimits& limits = short_times()) : SessionTest(limits) {}
  static ServerLimits short_times() {
    ServerLimits limits = unhurried_limits();
    limits.resume_time = kResumeTime;
    limits.hibernate_after = kHibernateAfter;
    limits.expire_after = 0s;
    return limits;
  }

  Json listed(const std::string& session) { return client->listed(session); }
  std::uint64_t tick_of(const std::string& session) { return listed(session).at("tick"); }
  std::string create() { return client->create_session(); }
  /// Returns the number of sessions in a state.
  std::string count(const std::string& state) {
    const std::string metrics = server.metrics();
    const std::string name = "vat_sessions{state=\"" + state + "\"} ";
    const std::size_t begin = metrics.find(name) + name.size();
    return metrics.substr(begin, metrics.find('\n', begin) - begin);
  }
};

TEST_F(EmptySession, HibernatesInTimeAndContinuesWhenSomebodyJoins) {
  const std::string session = create();
  server.clock().advance(kHibernateAfter - kStatusInterval);
  EXPECT_EQ(count("playing"), "1");
  server.clock().advance(2 * kStatusInterval);
  EXPECT_EQ(count("hibernating"), "1");
  const std::uint64_t tick = tick_of(session);
  EXPECT_NEAR(static_cast<double>(tick), 10 / 0.02, 0.5 / 0.02)
      << "the session has played for ten seconds";
  server.clock().advance(10s);
  EXPECT_EQ(tick_of(session), tick);
  const auto visitor = join(session);
  EXPECT_TRUE(listed(session).at("playing"));
  server.clock().advance(1s);
  EXPECT_EQ(tick_of(session), tick + 50);
  server.clock().advance(2 * kHibernateAfter);
  EXPECT_EQ(tick_of(session), tick + 50 + 1000) << "plays while somebody is in it";
  EXPECT_EQ(count("hibernating"), "0");
  visitor->result("control.pause");
  EXPECT_EQ(visitor->result("session.hash").at("hash"), mixed_hash_after(tick + 50 + 1000))
      << "the same bits as a session that was never empty";
}

// The participant may resume.
TEST_F(EmptySession, IsNotEmptyWhileSomebodyIsAway) {
  const std::string session = create();
  join(session)->disconnect();
  server.clock().advance(kHibernateAfter + kStatusInterval);
  EXPECT_EQ(count("playing"), "1");
  server.clock().advance(kResumeTime);
  EXPECT_EQ(count("hibernating"), "1");
}

class ExpiringSession : public EmptySession {
 protected:
  ExpiringSession() : EmptySession(expiring()) {}
  static ServerLimits expiring() {
    ServerLimits limits = short_times();
    limits.expire_after = kExpireAfter;
    return limits;
  }
};

TEST_F(ExpiringSession, EndsInTimeButNotTheFirst) {
  const std::string session = create();
  client->result("session.leave");
  server.clock().advance(kExpireAfter - kStatusInterval);
  EXPECT_FALSE(listed(session).is_null());
  server.clock().advance(kExpiryCheck + kStatusInterval);
  EXPECT_TRUE(listed(session).is_null());
  server.clock().advance(kExpireAfter);
  EXPECT_FALSE(listed("s1").is_null());
}

TEST_F(ExpiringSession, WithSomebodyInItDoesNotEnd) {
  const std::string session = create();
  const auto visitor = join(session);
  visitor->result("control.pause");
  server.clock().advance(2 * kExpireAfter);
  EXPECT_FALSE(listed(session).is_null());
  visitor->disconnect();
  server.clock().advance(kExpireAfter);
  EXPECT_FALSE(listed(session).is_null()) << "its participant was disconnected at first";
  server.clock().advance(kResumeTime + kExpiryCheck);
  EXPECT_TRUE(listed(session).is_null());
}

class NeverIdle : public EmptySession {
 protected:
  NeverIdle() : EmptySession(never()) {}
  static ServerLimits never() {
    ServerLimits limits = unhurried_limits();
    limits.hibernate_after = limits.expire_after = 0ms;
    return limits;
  }
};

TEST_F(NeverIdle, PlaysWithoutParticipants) {
  create();
  server.clock().advance(30s);
  EXPECT_EQ(count("playing"), "1");
}

TEST(EmptyReplay, EndsInTimeThoughSessionsDoNot) {
  const TemporaryFolder folder;
  const Catalogue catalogue = make_catalogue();
  ServerLimits limits = unhurried_limits();
  limits.resume_time = kResumeTime;
  limits.hibernate_after = 1s;
  limits.expire_after = 0ms;
  limits.replay_expire_after = kExpireAfter;
  Host host(catalogue, folder.file("data"), limits);
  TestServer& server = host.server;
  TestClient& client = *host.client;
  client.create_session();
  const auto sessions = [&] { return client.result("session.list").at("sessions").size(); };
  const Json replay = client.result("replay.open", {{"session", "s1"}}).at("session");
  client.result("session.join", {{"session", replay}});
  server.clock().advance(2 * kExpireAfter);
  EXPECT_EQ(sessions(), 3U) << "a client is in the replay";
  client.result("session.join", {{"session", "s1"}});
  server.clock().advance(kExpireAfter - 1s);
  EXPECT_EQ(sessions(), 3U);
  server.clock().advance(1s + kExpiryCheck);
  EXPECT_EQ(client.error("session.join", {{"session", replay}}).at("code"), 1002);
  EXPECT_EQ(sessions(), 2U);
}

// Work of sessions without commands and ticks.

class IdleSession : public SessionTest {};

// A client is connected, so statuses continue.
TEST_F(IdleSession, WakesForItsStatusesOnly) {
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  server.clock().advance(
      1s);  // lets the first frame be acknowledged and the last heartbeat be sent
  const std::size_t frames = client->connection->frame_count();
  const std::size_t tasks = server.clock().tasks_run();
  client->mark();
  server.clock().advance(10s);
  EXPECT_EQ(client->connection->frame_count(), frames);
  EXPECT_EQ(client->events("session.status").size(), 20U);
  EXPECT_LE(server.clock().tasks_run() - tasks, 20U + 1)
      << "one more for the check of expired sessions";
  client->result("session.leave");
  server.clock().advance(1s);
  const std::size_t before = server.clock().tasks_run();
  server.clock().advance(10s);
  EXPECT_LE(server.clock().tasks_run() - before, 20U + 1) << "an empty session";
}

// Sessions that their creators have abandoned can be closed by others from the same address.

class AbandonedSession : public SessionTest {
 protected:
  AbandonedSession() : SessionTest(limits()) {}
  static ServerLimits limits() {
    ServerLimits limits = unhurried_limits();
    limits.resume_time = kResumeTime;
    limits.max_sessions_per_address = 2;
    return limits;
  }
  static bool closable(TestClient& client, const std::string& session) {
    return client.listed(session).at("closable");
  }
  /// Returns a session whose owner has disconnected and can no longer resume.
  std::string abandon() {
    const auto owner = connect();
    std::string session = owner->create_session();
    owner->result("session.join", {{"session", session}});
    owner->disconnect();
    server.clock().advance(kResumeTime + kStatusInterval);
    return session;
  }
};

TEST_F(AbandonedSession, AreClosedByAControllerOfTheirAddressOnly) {
  const std::string session = abandon();
  const auto elsewhere = connect_from("10.0.0.7");
  EXPECT_FALSE(closable(*elsewhere, session));
  EXPECT_EQ(elsewhere->error("session.close", {{"session", session}}).at("code"), 1006);
  EXPECT_TRUE(closable(*client, session));
  client->result("session.close", {{"session", session}});
  EXPECT_EQ(client->error("session.join", {{"session", session}}).at("code"), 1002);
}

TEST_F(AbandonedSession, MakeRoomForNewOnesOfTheirAddress) {
  const std::string session = abandon();
  const auto owner = connect();
  owner->create_session();
  const Json error = client->error("session.create", {{"name", "n"}, {"scene", "mixed"}});
  EXPECT_EQ(error.at("data").at("limit"), "sessions_per_address");
  EXPECT_EQ(error.at("data").at("abandoned"), 1) << "the creator of the other is connected";
  EXPECT_TRUE(has_sample(server.metrics(), "vat_abandoned_sessions 1"));
  EXPECT_TRUE(has_sample(server.metrics(), R"(vat_refused_total{limit="sessions_per_address"} 1)"));
  connect_from("10.0.0.7")->create_session();
  client->result("session.close", {{"session", session}});
  client->create_session();
}

TEST_F(AbandonedSession, AreNotThoseWithAnOwnerOrAParticipant) {
  const auto owner = connect();
  const std::string session = owner->create_session();
  EXPECT_FALSE(closable(*client, session)) << "the owner may still join";
  EXPECT_TRUE(closable(*owner, session));
  const auto guest = join(session);
  owner->disconnect();
  server.clock().advance(2 * kResumeTime);
  EXPECT_FALSE(closable(*client, session)) << "there is a guest";
  guest->disconnect();
  server.clock().advance(kResumeTime / 2);
  EXPECT_FALSE(closable(*client, session)) << "the guest may resume";
  EXPECT_EQ(client->error("session.close", {{"session", session}}).at("code"), 1006);
  server.clock().advance(kResumeTime);
  EXPECT_TRUE(closable(*client, session));
  client->result("session.close", {{"session", session}});
  client->result("session.leave");
  server.clock().advance(2 * kResumeTime);
  EXPECT_FALSE(closable(*client, "s1")) << "the first session";
  EXPECT_TRUE(has_sample(server.metrics(), "vat_abandoned_sessions 0"));
}

}  // namespace
}  // namespace vat::test::empty_session_test
