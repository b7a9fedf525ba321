// Access control. Tests with the prefix Owasp cover items of the OWASP list for WebSockets.

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "server/access/access.h"
#include "server/access/token.h"
#include "server/cli/serve/serve_access.h"
#include "tests/server/fixture/access_fixture.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::access_test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kNotAuthenticated = 4001;

class Access : public AccessTest {};
class DelayedAccess : public AccessTest {
 protected:
  DelayedAccess() : AccessTest(AccessSettings{}.refusal_delay) {}
};
class OpenAccess : public SessionTest {};

TEST_F(OpenAccess, LetsEverybodyInAsAController) {
  const auto guest = connect();
  EXPECT_EQ(guest->result("server.info").at("access"), "open");
  EXPECT_EQ(guest->result("session.join").at("role"), "controller");
}

TEST_F(OpenAccess, OnlyAnAdminOwnsTheFirstSession) {
  EXPECT_EQ(client->error("session.close", {{"session", "s1"}}).at("code"), 1006);
  EXPECT_EQ(client->error("session.configure").at("code"), 1006);
  const auto admin = connect_admin();
  EXPECT_EQ(admin->result("session.join").at("role"), "admin");
  admin->result("session.configure", {{"default_role", "viewer"}});
  EXPECT_EQ(connect()->result("session.join").at("role"), "viewer");
  admin->result("session.close", {{"session", "s1"}});
}

TEST_F(OpenAccess, TheCreatorOwnsASession) {
  const std::string own =
      client->result("session.create", {{"name", "own"}, {"scene", "mixed"}}).at("session");
  const auto guest = join(own);
  EXPECT_EQ(guest->error("session.close", {{"session", own}}).at("data").at("role"), "controller");
  EXPECT_EQ(client->result("session.join", {{"session", own}}).at("role"), "owner");
  client->result("session.close", {{"session", own}});
}

TEST_F(OpenAccess, TheCreatorMayCloseASessionFromOutside) {
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
  EXPECT_EQ(refused.at("error").at("data").at("limit"), "message_bytes")
      << "rejected before parsing";
}

TEST_F(DelayedAccess, OwaspAConnectionThatDoesNotAuthenticateIsClosed) {
  const auto stranger = connect();
  server.clock().advance(AccessSettings{}.enter_time - 1ms);
  EXPECT_EQ(stranger->connection->close_code(), std::nullopt);
  server.clock().advance(1ms);
  EXPECT_EQ(stranger->connection->close_code(), kNotAuthenticated);
  EXPECT_EQ(admin->connection->close_code(), std::nullopt)
      << "an older connection with a token stays open";
  admin->result("server.info");
}

TEST_F(DelayedAccess, OwaspWrongTokensAreAnsweredLateAndThenNotHeard) {
  const auto guest = connect();
  const int first = guest->send("access.enter", {{"token", "wrong"}});
  const auto is_answered = [&] {
    return guest->connection->find_text(
        [&](const Json& text) { return text.value("id", Json()) == first; });
  };
  server.clock().advance(AccessSettings{}.refusal_delay - 1ms);
  EXPECT_FALSE(is_answered());
  server.clock().advance(1ms);
  EXPECT_EQ(guest->wait_reply(first).at("error").at("code"), 1007);
  const int second = guest->send("access.enter", {{"token", "wrong again"}});
  const int third = guest->send("access.enter", {{"token", ""}});
  const int right = guest->send("access.enter", {{"token", kAdminToken}});
  server.clock().advance(AccessSettings{}.refusal_delay);
  for (const int id : {second, third})
    EXPECT_EQ(guest->wait_reply(id).at("error").at("code"), 1007);
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
  EXPECT_EQ(joined.at("session"), own) << "an invitation selects its session";
  EXPECT_EQ(joined.at("role"), "controller");
  EXPECT_EQ(guest->error("session.join", {{"session", "s1"}}).at("code"), 1006);
  EXPECT_EQ(guest->error("session.create", {{"name", "n"}, {"scene", "mixed"}}).at("code"), 1006);
  const Json list = guest->result("session.list").at("sessions");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list.at(0).at("session"), own);
}

TEST_F(Access, AnInvitationIsValidForItsNumberOfUses) {
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

std::optional<std::string> issue_token(AccessTokens& tokens, std::optional<std::size_t> uses,
                                       std::chrono::seconds time) {
  std::optional<std::string> token;
  tokens.issue({Role::viewer, "s1", true}, uses, time,
               [&](const AccessTokens::Issued& issued) { token = issued.token; });
  return token;
}

TEST(AccessTokens, AreGoodUntilTheirEnd) {
  ManualClock clock;
  AccessTokens tokens(10, clock);
  const TokenHash token = hash_of_token(issue_token(tokens, {}, 60s).value());
  clock.advance(60s - 1ns);
  EXPECT_TRUE(tokens.use(token));
  clock.advance(1ns);
  EXPECT_FALSE(tokens.use(token));
}

TEST(AccessTokens, AreBoundedAndOldOnesMakeRoom) {
  ManualClock clock;
  AccessTokens tokens(2, clock);
  const auto issue = [&](std::chrono::seconds time) { return issue_token(tokens, 1, time); };
  EXPECT_TRUE(issue(10s));
  const auto second = issue(100s);
  clock.advance(9s);
  EXPECT_FALSE(issue(10s));
  clock.advance(1s);
  EXPECT_TRUE(issue(100s)) << "the first ticket has expired";
  EXPECT_FALSE(issue(10s));
  EXPECT_TRUE(tokens.use(hash_of_token(second.value())));
  EXPECT_TRUE(issue(10s)) << "the second ticket is used";
  tokens.remove_session("s1", false);
  EXPECT_TRUE(issue(10s));
  EXPECT_TRUE(issue(10s));
}

std::string to_hex(const TokenHash& hash) {
  std::string text;
  for (const std::uint8_t byte : hash) {
    for (const int digit : {byte >> 4, byte & 15}) text += "0123456789abcdef"[digit];
  }
  return text;
}

// FIPS 180-2, appendix B.1.
TEST(Token, IsHashedBySha256) {
  EXPECT_EQ(to_hex(hash_of_token("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Token, HashesAreTheSameOrNot) {
  const TokenHash hash = hash_of_token("abc");
  for (std::size_t i = 0; i < hash.size(); ++i) {
    TokenHash other = hash;
    EXPECT_TRUE(are_same(hash, other));
    other[i] ^= 1;
    EXPECT_FALSE(are_same(hash, other)) << i;
  }
}

// All 22 characters vary: the last has 2 bits, the others 6. With 4096 tokens, the probability that
// some value of some character is missing is below 22 * 64 * exp(-4096 / 64), about 1e-25.
TEST(Token, IsOfRandomCharactersAndNeverTheSame) {
  std::set<std::string> tokens;
  std::vector<std::set<char>> seen(22);
  for (int i = 0; i < 4096; ++i) {
    const std::string token = make_token();
    ASSERT_EQ(token.size(), 22u);
    for (std::size_t c = 0; c < token.size(); ++c) seen[c].insert(token[c]);
    tokens.insert(token);
  }
  EXPECT_EQ(tokens.size(), 4096u);
  for (std::size_t c = 0; c < 21; ++c) EXPECT_EQ(seen[c].size(), 64u) << c;
  EXPECT_EQ(seen[21].size(), 4u);
}

// Access by the options of `vat serve`.

constexpr const char* kVariable = "VAT_ADMIN_TOKEN";
constexpr const char* kToken = "0123456789abcdef";  // the minimum length

class ServeAccessTest : public testing::Test {
 protected:
  ServeAccessTest() { unsetenv(kVariable); }
  void TearDown() override { unsetenv(kVariable); }

  ServeAccess made() {
    const Result<ServeAccess> access = serve_access(settings);
    EXPECT_TRUE(access.ok());
    return access ? access.value() : ServeAccess{};
  }
  std::string refusal() {
    const Result<ServeAccess> access = serve_access(settings);
    EXPECT_FALSE(access.ok());
    return access ? "" : access.errors().front().code;
  }

  const TemporaryFolder folder;
  ServeSettings settings;
};

TEST_F(ServeAccessTest, IsOpenOnlyIfAllClientsAreOnThisMachine) {
  for (const char* host : {"127.0.0.1", "127.3.2.1", "::1"}) {
    settings.host = host;
    EXPECT_EQ(made().settings.mode, AccessMode::open) << host;
  }
  for (const char* host : {"0.0.0.0", "::", "10.0.0.1"}) {
    settings.host = host;
    EXPECT_EQ(made().settings.mode, AccessMode::token) << host;
  }
  settings.host = "127.0.0.1";
  settings.public_name = {"vat.example"};
  EXPECT_EQ(made().settings.mode, AccessMode::token);
  settings.public_name.clear();
  settings.trusted_proxy = {"127.0.0.1"};
  EXPECT_EQ(made().settings.mode, AccessMode::token);
  settings.access = "open";
  EXPECT_EQ(made().settings.mode, AccessMode::open);
  settings.host = "127.0.0.1";
  settings.access = "token";
  EXPECT_EQ(made().settings.mode, AccessMode::token);
}

TEST_F(ServeAccessTest, MakesANeededAdminTokenIfNoneIsGiven) {
  EXPECT_TRUE(made().made_token.empty());
  EXPECT_FALSE(made().settings.admin);
  settings.access = "token";
  const ServeAccess first = made();
  EXPECT_EQ(first.settings.admin, hash_of_token(first.made_token));
  EXPECT_NE(first.made_token, made().made_token);
  setenv(kVariable, kToken, 1);
  EXPECT_TRUE(made().made_token.empty());
  EXPECT_EQ(made().settings.admin, hash_of_token(kToken));
  settings.access = "open";
  EXPECT_EQ(made().settings.admin, hash_of_token(kToken))
      << "the admin token also works in open mode";
}

TEST_F(ServeAccessTest, TakesTheFirstLineOfAFileBeforeTheVariable) {
  setenv(kVariable, "another token of the admin", 1);
  folder.write("token", std::string(kToken) + "\nnot this\n");
  settings.admin_token_file = folder.file("token");
  EXPECT_EQ(made().settings.admin, hash_of_token(kToken));
}

TEST_F(ServeAccessTest, RefusesUnreadableFilesAndWeakTokens) {
  settings.admin_token_file = folder.file("missing");
  EXPECT_EQ(refusal(), "unreadable_file");
  folder.write("empty", "");
  settings.admin_token_file = folder.file("empty");
  EXPECT_EQ(refusal(), "unreadable_file");
  folder.write("short", "0123456789abcde\n");
  settings.admin_token_file = folder.file("short");
  EXPECT_EQ(refusal(), "out_of_range");
  settings.admin_token_file.clear();
  setenv(kVariable, "0123456789abcde", 1);
  EXPECT_EQ(refusal(), "out_of_range");
  setenv(kVariable, "", 1);
  EXPECT_EQ(refusal(), "out_of_range");
}

}  // namespace
}  // namespace vat::test::access_test
