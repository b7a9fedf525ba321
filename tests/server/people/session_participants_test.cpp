// Participants of a session, and their persistence after a disconnection.

#include <regex>

#include "tests/server/fixture/session_fixture.h"

namespace vat::test::session_participants_test {
namespace {

constexpr std::uint16_t kReplaced = 4010;

class SessionParticipants : public SessionTest {
 protected:
  using SessionTest::SessionTest;

  static Json resume_params(const Json& joined) {
    return {{"session", joined.at("session")}, {"resume", joined.at("resume")}};
  }
  void wait_for_clients(int count) {
    client->wait_event("session.status", [&](const Json& s) { return s.at("clients") == count; });
  }
};

class AwayForAMoment : public SessionParticipants {
 protected:
  AwayForAMoment()  // absences end at the next status
      : SessionParticipants(limits_with(&ServerLimits::resume_time, std::chrono::milliseconds(1))) {
  }
};

class FewParticipants : public SessionParticipants {
 protected:
  FewParticipants() : SessionParticipants(limits_with(&ServerLimits::max_clients_per_session, 2)) {}
};

TEST_F(SessionParticipants, ReceiveTheirNumbersAndRoles) {
  const auto guest = connect();
  const Json joined = guest->result("session.join", {{"name", "Ada Łovelace"}});
  EXPECT_EQ(joined.at("participant"), 2);
  EXPECT_EQ(joined.at("name"), "Ada Łovelace");
  EXPECT_EQ(joined.at("role"), "controller");
  EXPECT_EQ(joined.at("resumed"), false);
  EXPECT_TRUE(
      std::regex_match(joined.at("resume").get<std::string>(), std::regex("[A-Za-z0-9_-]{22}")))
      << "128 bits as base64url";
}

TEST_F(SessionParticipants, HaveNumbersThatAreNeverUsedTwiceAndTokensOfTheirOwn) {
  const auto guest = connect();
  const Json first = guest->result("session.join");
  guest->result("session.leave");
  const Json second = guest->result("session.join");
  EXPECT_EQ(first.at("participant"), 2);
  EXPECT_EQ(first.at("name"), "guest 2");
  EXPECT_EQ(second.at("participant"), 3);
  EXPECT_NE(first.at("resume"), second.at("resume"));
}

TEST_F(SessionParticipants, MayHaveALowerRoleThanTheirs) {
  const auto guest = connect();
  EXPECT_EQ(guest->result("session.join", {{"role", "viewer"}}).at("role"), "viewer");
  EXPECT_EQ(guest->error("control.play").at("code"), 1006);
  EXPECT_EQ(guest->result("session.join", {{"role", "controller"}}).at("role"), "controller");
  const std::string session = guest->create_session();
  const Json watching = guest->result("session.join", {{"session", session}, {"role", "viewer"}});
  EXPECT_EQ(watching.at("role"), "viewer");
  EXPECT_EQ(guest->result("session.join", {{"session", session}}).at("role"), "owner")
      << "the creator is still the owner";
}

TEST_F(SessionParticipants, CannotRequestAHigherRole) {
  const auto owner = connect();
  const std::string session = owner->create_session();
  owner->result("session.join", {{"session", session}});
  owner->result("session.configure", {{"default_role", "viewer"}});
  const auto guest = connect();
  const Json joined = guest->result("session.join", {{"session", session}, {"role", "controller"}});
  EXPECT_EQ(joined.at("role"), "viewer");
}

TEST_F(SessionParticipants, HaveNamesThatCanBeShown) {
  const auto guest = connect();
  const char* const wrong[] = {"",           "  ",          "\u00a0",       "a\u202eb",
                               "a\u200bb",   "\u2066x",     "tab\there",    "a\u0085b",
                               "\ufeffname", "del\u007fet", "\U000e0041tag"};
  for (const char* name : wrong) {
    const Json error = guest->error("session.join", {{"name", name}});
    EXPECT_EQ(error.at("data").at("path"), "/name") << name;
    EXPECT_EQ(error.at("data").at("errors").at(0).at("code"), "bad_text") << name;
  }
  EXPECT_EQ(guest->error("session.join", {{"name", std::string(65, 'x')}}).at("data").at("path"),
            "/name");
  for (const char* name : {"<b>x</b>", "名前", "naïve café", "🌊"}) {
    EXPECT_EQ(guest->result("session.join", {{"name", name}}).at("name"), name);
  }
  EXPECT_EQ(guest->error("participant.rename", {{"name", "\u202e"}}).at("data").at("path"),
            "/name");
}

TEST_F(SessionParticipants, AreResumedWithAllThatTheyHad) {
  auto guest = connect();
  const Json joined = guest->result("session.join", {{"name", "Eve"}});
  const std::uint64_t grab = guest->grab(3);
  guest->result("frames.subscribe", {{"max_error", 0.01}});
  guest->wait_frame([](const GridFrame&) { return true; });
  guest->disconnect();
  wait_for_clients(1);

  guest = connect();
  Json params = resume_params(joined);
  params["name"] = "another name is not taken";
  const Json again = guest->result("session.join", params);
  EXPECT_EQ(again.at("participant"), joined.at("participant"));
  EXPECT_EQ(again.at("name"), "Eve");
  EXPECT_EQ(again.at("resume"), joined.at("resume"));
  EXPECT_EQ(again.at("resumed"), true);
  guest->wait_frame([](const GridFrame&) { return true; });  // no client has subscribed again
  guest->result("grab.end", {{"grab", grab}});
}

TEST_F(SessionParticipants, CanBeTakenOverFromAConnectionThatIsStillOpen) {
  const auto old = connect();
  const Json joined = old->result("session.join");
  const std::uint64_t grab = old->grab(3);
  const auto next = connect();
  EXPECT_EQ(next->result("session.join", resume_params(joined)).at("participant"),
            joined.at("participant"));
  old->wait_closed();
  EXPECT_EQ(old->connection->close_code(), kReplaced);

  const std::size_t texts = old->connection->texts().size();
  old->send("session.join");
  old->send("grab.end", {{"grab", grab}});
  old->disconnect();
  next->result("grab.move", {{"grab", grab}, {"target", {0.5, 0.5, 0.8}}});
  EXPECT_EQ(old->connection->texts().size(), texts) << "messages of the old connection are ignored";
  EXPECT_EQ(client->result("session.list").at("sessions").at(0).at("clients"), 2);
}

TEST_F(SessionParticipants, StayTheSameOnTheirOwnConnectionToo) {
  const auto guest = connect();
  const Json joined = guest->result("session.join");
  const std::uint64_t grab = guest->grab(3);
  EXPECT_EQ(guest->result("session.join", resume_params(joined)).at("resumed"), true);
  guest->result("grab.end", {{"grab", grab}});
  EXPECT_EQ(guest->connection->close_code(), std::nullopt);
}

TEST_F(SessionParticipants, AnotherTokenCreatesANewParticipant) {
  const std::string second = client->create_session();
  const auto guest = connect();
  const auto join_with = [&](const std::string& session, const std::string& token) {
    const Json joined = guest->result("session.join", {{"session", session}, {"resume", token}});
    EXPECT_EQ(joined.at("resumed"), false);
    EXPECT_NE(joined.at("resume"), token);
    return joined.at("resume").get<std::string>();
  };
  const std::string first = join_with("s1", "AAAAAAAAAAAAAAAAAAAAAA");
  guest->result("session.leave");
  const std::string next = join_with("s1", first);  // a participant that left
  join_with(second, next);                          // a participant of another session
}

TEST_F(AwayForAMoment, LeaveAndReleaseTheirGrabs) {
  auto guest = connect();
  const Json joined = guest->result("session.join");
  const std::uint64_t grab = guest->grab(3);
  EXPECT_EQ(client->error("grab.end", {{"grab", grab}}).at("code"), 1006);
  guest->disconnect();
  client->mark();
  wait_for_clients(1);  // reports the disconnection
  client->mark();
  wait_for_clients(1);  // reports the end of the absence, or of the time after it
  client->mark();
  wait_for_clients(1);
  EXPECT_EQ(client->error("grab.end", {{"grab", grab}}).at("code"), -32602) << "the grab has ended";
  guest = connect();
  EXPECT_EQ(guest->result("session.join", resume_params(joined)).at("resumed"), false);
}

TEST_F(FewParticipants, TheFirstOfTooManyAbsentOnesLeaves) {
  std::vector<Json> joined;
  for (int i = 0; i < 3; ++i) {
    auto guest = connect();
    joined.push_back(guest->result("session.join"));
    guest->disconnect();
  }
  const auto guest = connect();
  EXPECT_EQ(guest->result("session.join", resume_params(joined[1])).at("resumed"), true);
  EXPECT_EQ(guest->result("session.join", resume_params(joined[0])).at("resumed"), false);
}

}  // namespace
}  // namespace vat::test::session_participants_test
