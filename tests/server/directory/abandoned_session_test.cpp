// Sessions that their creators have abandoned can be closed by others from the same address.

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::abandoned_session_test {
namespace {

using namespace std::chrono_literals;

constexpr auto kResumeTime = 2s;
constexpr auto kStatusInterval = 500ms;  // after it, a session removes an absent participant

class AbandonedSession : public SessionTest {
 protected:
  AbandonedSession() : SessionTest(limits()) {}
  static ServerLimits limits() {
    ServerLimits limits = unhurried_limits();
    limits.resume_time = kResumeTime;
    limits.max_sessions_per_address = 2;
    return limits;
  }
  static std::string create(TestClient& creator) {
    return creator.result("session.create", {{"name", "n"}, {"scene", "mixed"}}).at("session");
  }
  static bool closable(TestClient& client, const std::string& session) {
    const Json sessions = client.result("session.list").at("sessions");
    for (const Json& entry : sessions) {
      if (entry.at("session") == session) return entry.at("closable");
    }
    throw std::runtime_error("the session is not listed");
  }
  /// Returns a session whose owner has disconnected and can no longer resume.
  std::string abandon() {
    const auto owner = connect();
    std::string session = create(*owner);
    owner->result("session.join", {{"session", session}});
    owner->disconnect();
    server.clock().advance(kResumeTime + kStatusInterval);
    return session;
  }
  bool metrics_have(const std::string& line) {
    return server.metrics().find('\n' + line + '\n') != std::string::npos;
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
  create(*owner);
  const Json error = client->error("session.create", {{"name", "n"}, {"scene", "mixed"}});
  EXPECT_EQ(error.at("data").at("limit"), "sessions_per_address");
  EXPECT_EQ(error.at("data").at("abandoned"), 1) << "the creator of the other is connected";
  EXPECT_TRUE(metrics_have("vat_abandoned_sessions 1"));
  client->result("session.close", {{"session", session}});
  create(*client);
}

TEST_F(AbandonedSession, AreNotThoseWithAnOwnerOrAParticipant) {
  const auto owner = connect();
  const std::string session = create(*owner);
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
}

TEST_F(AbandonedSession, AreNeverTheFirst) {
  client->result("session.leave");
  server.clock().advance(2 * kResumeTime);
  EXPECT_FALSE(closable(*client, "s1"));
  EXPECT_TRUE(metrics_have("vat_abandoned_sessions 0"));
}

}  // namespace
}  // namespace vat::test::abandoned_session_test
