// Who is let in. The names that begin with Owasp are items of OWASP's list for WebSockets.

#include "server/access/access.h"

#include "tests/server/access_fixture.h"

namespace vat::test::access_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kNotAuthenticated = 4001;

AccessSettings quick() {
  AccessSettings access;
  access.enter_time = 100ms;
  access.refusal_delay = 100ms;
  return access;
}

class Access : public AccessTest {};
class QuickAccess : public AccessTest {
 protected:
  QuickAccess() : AccessTest(quick()) {}
};
class OpenAccess : public SessionTest {};

TEST_F(OpenAccess, LetsEverybodyInAsAController) {
  const auto guest = connect();
  EXPECT_EQ(guest->result("server.info").at("access"), "open");
  EXPECT_EQ(guest->result("session.join").at("role"), "controller");
}

TEST_F(OpenAccess, NobodyOwnsTheFirstSessionButAnAdmin) {
  EXPECT_EQ(client->error("session.close", {{"session", "s1"}}).at("code"), 1006);
  EXPECT_EQ(client->error("session.configure").at("code"), 1006);
  const auto admin = connect_admin();
  EXPECT_EQ(admin->result("session.join").at("role"), "admin");
  admin->result("session.configure", {{"default_role", "viewer"}});
  EXPECT_EQ(connect()->result("session.join").at("role"), "viewer");
  admin->result("session.close", {{"session", "s1"}});
}

TEST_F(OpenAccess, WhoMakesASessionOwnsIt) {
  const std::string own =
      client->result("session.create", {{"name", "own"}, {"scene", "mixed"}}).at("session");
  const auto guest = join(own);
  EXPECT_EQ(guest->error("session.close", {{"session", own}}).at("data").at("role"), "controller");
  EXPECT_EQ(client->result("session.join", {{"session", own}}).at("role"), "owner");
  client->result("session.close", {{"session", own}});
}

TEST_F(OpenAccess, WhoMakesASessionMayCloseItFromOutside) {
  const std::string own =
      client->result("session.create", {{"name", "own"}, {"scene", "mixed"}}).at("session");
  EXPECT_EQ(connect()->error("session.close", {{"session", own}}).at("code"), 1006);
  client->result("session.close", {{"session", own}});
}

TEST_F(Access, OwaspNothingIsDoneBeforeAuthentication) {
  const auto stranger = connect();
  EXPECT_EQ(stranger->result("server.info").at("access"), "token");
  for (const char* method :
       {"session.join", "scene.list", "frames.ack", "session.hash", "no.such"}) {
    EXPECT_EQ(stranger->error(method).at("code"), 1007) << method;
  }
  const Json long_scene = {{"scene", {{"name", std::string(70'000, 'x')}}}};
  const Json request{
      {"jsonrpc", "2.0"}, {"id", 9}, {"method", "scene.load"}, {"params", long_scene}};
  stranger->send_raw(request.dump(), true);
  const Json refused =
      stranger->connection->wait_text([](const Json& text) { return text.at("id").is_null(); });
  EXPECT_EQ(refused.at("error").at("data").at("limit"), "message_bytes") << "it is not even parsed";
}

TEST_F(QuickAccess, OwaspAConnectionThatDoesNotAuthenticateIsClosed) {
  const auto stranger = connect();
  stranger->connection->wait_closed();
  EXPECT_EQ(stranger->connection->close_code(), kNotAuthenticated);
  EXPECT_EQ(admin->connection->close_code(), std::nullopt) << "it is older, and has entered";
  admin->result("server.info");
}

TEST_F(QuickAccess, OwaspWrongTokensAreAnsweredLateAndThenNotHeard) {
  const auto guest = enter(ticket({{"role", "viewer"}}));  // so that its time is not up
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(guest->error("access.enter", {{"token", "wrong"}}).at("code"), 1007);
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 100ms);
  const int second = guest->send("access.enter", {{"token", "wrong again"}});
  const int third = guest->send("access.enter", {{"token", ""}});
  const int right = guest->send("access.enter", {{"token", kAdminToken}});
  for (const int id : {second, third})
    EXPECT_EQ(guest->wait_reply(id).at("error").at("code"), 1007);
  guest->connection->wait_closed();
  EXPECT_EQ(guest->connection->close_code(), kNotAuthenticated);
  for (const Json& text : guest->connection->texts()) {
    EXPECT_FALSE(text.value("id", 0) == right && text.contains("result"));
  }
}

TEST_F(Access, OwaspATicketIsGoodOnce) {
  const std::string token = ticket({{"role", "viewer"}});
  enter(token);
  EXPECT_EQ(connect()->error("access.enter", {{"token", token}}).at("code"), 1007);
}

TEST_F(Access, ATicketOfTheServerGivesItsRoleInEverySession) {
  const auto guest = enter(ticket({{"role", "controller"}}));
  EXPECT_EQ(guest->result("session.join", {{"session", "s1"}}).at("role"), "controller");
  const auto viewer = enter(ticket({{"role", "viewer"}}));
  EXPECT_EQ(viewer->result("session.join").at("role"), "viewer");
  EXPECT_EQ(viewer->error("session.create", {{"name", "n"}, {"scene", "mixed"}}).at("code"), 1006);
}

TEST_F(Access, OnlyAnAdminGivesTicketsForAll) {
  const auto owner = this->owner();
  EXPECT_EQ(owner->error("access.ticket", {{"role", "viewer"}}).at("data").at("least_role"),
            "admin");
  EXPECT_EQ(owner->error("access.ticket", {{"role", "viewer"}, {"session", "s1"}}).at("code"),
            1006);
  EXPECT_EQ(owner->error("access.ticket", {{"role", "admin"}, {"session", own}}).at("code"),
            -32602);
  const Json given = owner->result("access.ticket", {{"role", "viewer"}, {"session", own}});
  const auto guest = enter(given.at("token"));
  EXPECT_EQ(guest->result("session.join").at("session"), own);
  EXPECT_EQ(owner->error("access.ticket", {{"role", "viewer"}, {"session", "s9"}}).at("code"),
            1002);
}

TEST_F(Access, AnInvitationOpensOneSessionAndNoOther) {
  const auto owner = this->owner();
  const auto guest = invited(*owner, "controller");
  EXPECT_EQ(joined.at("session"), own) << "without an id: the one it is for";
  EXPECT_EQ(joined.at("role"), "controller");
  EXPECT_EQ(guest->error("session.join", {{"session", "s1"}}).at("code"), 1006);
  EXPECT_EQ(guest->error("session.create", {{"name", "n"}, {"scene", "mixed"}}).at("code"), 1006);
  const Json list = guest->result("session.list").at("sessions");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list.at(0).at("session"), own);
}

TEST_F(Access, AnInvitationIsGoodAsOftenAsItSays) {
  const auto owner = this->owner();
  const std::string twice =
      owner->result("session.invite", {{"role", "viewer"}, {"uses", 2}}).at("token");
  enter(twice);
  enter(twice);
  EXPECT_EQ(connect()->error("access.enter", {{"token", twice}}).at("code"), 1007);
  const std::string any = owner->result("session.invite", {{"role", "viewer"}}).at("token");
  for (int i = 0; i < 5; ++i) enter(any);
}

TEST_F(Access, InvitationsEndWithTheirSession) {
  const auto owner = this->owner();
  const std::string token = owner->result("session.invite", {{"role", "viewer"}}).at("token");
  owner->result("session.close", {{"session", own}});
  EXPECT_EQ(connect()->error("access.enter", {{"token", token}}).at("code"), 1007);
}

TEST_F(Access, AResumeTokenLetsItsParticipantInAgainAndNothingElse) {
  const auto owner = this->owner();
  auto guest = invited(*owner, "controller");
  guest->disconnect();
  guest = enter(joined.at("resume"));
  EXPECT_EQ(guest->error("session.join", {{"session", "s1"}}).at("code"), 1006);
  const Json again = guest->result("session.join", {{"resume", joined.at("resume")}});
  EXPECT_EQ(again.at("resumed"), true);
  EXPECT_EQ(again.at("role"), "controller");
  guest->result("session.leave");
  EXPECT_EQ(connect()->error("access.enter", {{"token", joined.at("resume")}}).at("code"), 1007);
}

TEST(AccessTokens, AreGoodUntilTheirEnd) {
  AccessTokens tokens(10);
  const AccessTokens::Clock::time_point start{};
  const TokenHash token =
      hash_of_token(tokens.issue({Role::viewer, "s1", true}, {}, start + 60s, start).value());
  EXPECT_TRUE(tokens.use(token, start + 60s - 1ns));
  EXPECT_FALSE(tokens.use(token, start + 60s));
}

TEST(AccessTokens, AreBoundedAndOldOnesMakeRoom) {
  AccessTokens tokens(2);
  const AccessTokens::Clock::time_point start{};
  const auto issue = [&](std::chrono::seconds life, std::chrono::seconds now) {
    return tokens.issue({Role::viewer, "s1", true}, 1, start + now + life, start + now);
  };
  EXPECT_TRUE(issue(10s, 0s));
  const auto second = issue(100s, 0s);
  EXPECT_FALSE(issue(10s, 9s));
  EXPECT_TRUE(issue(100s, 10s)) << "the first is old";
  EXPECT_FALSE(issue(10s, 10s));
  EXPECT_TRUE(tokens.use(hash_of_token(second.value()), start + 11s));
  EXPECT_TRUE(issue(10s, 11s)) << "the second is used up";
  tokens.remove_session("s1", false);
  EXPECT_TRUE(issue(10s, 11s));
  EXPECT_TRUE(issue(10s, 11s));
}

}  // namespace
}  // namespace vat::test::access_test
