// Access control. Tests with the prefix Owasp cover items of the OWASP list for WebSockets.

#include <gtest/gtest.h>

#include <set>

#include "server/access/access.h"
#include "server/access/signed_token.h"
#include "server/messages/limits.h"
#include "tests/server/fixture/access_fixture.h"

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

TEST_F(OpenAccess, OnlyAnAdminOwnsTheFirstSession) {
  EXPECT_EQ(client->error("session.close", {{"session", "s1"}}).at("code"), 1006);
  EXPECT_EQ(client->error("session.configure").at("code"), 1006);
  connect_admin()->result("session.close", {{"session", "s1"}});
}

TEST_F(OpenAccess, TheCreatorMayCloseASessionFromOutside) {
  const std::string own = client->create_session();
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

TEST_F(Access, AnInvitationGivesItsRoleToRequestsThatNameTheSession) {
  const auto by = owner();
  for (const char* const role : {"viewer", "controller"}) {
    const auto guest = enter(by->result("session.invite", {{"role", role}}).at("token"));
    EXPECT_EQ(guest->error("session.close", {{"session", own}}).at("data").at("role"), role);
    const Json other = guest->error("session.close", {{"session", "s1"}}).at("data");
    EXPECT_EQ(other.at("role"), "viewer") << role;
    const Json joined_as = guest->result("session.join");
    by->result("participant.set_role",
               {{"participant", joined_as.at("participant")}, {"role", "viewer"}});
    EXPECT_EQ(guest->error("session.close", {{"session", own}}).at("data").at("role"), "viewer")
        << "the role of the participant";
  }
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

// FIPS 180-2, appendix B.1.
TEST(Token, IsHashedBySha256) {
  const TokenHash expected{0xba, 0x78, 0x16, 0xbf, 0x8f, 0x01, 0xcf, 0xea, 0x41, 0x41, 0x40,
                           0xde, 0x5d, 0xae, 0x22, 0x23, 0xb0, 0x03, 0x61, 0xa3, 0x96, 0x17,
                           0x7a, 0x9c, 0xb4, 0x10, 0xff, 0x61, 0xf2, 0x00, 0x15, 0xad};
  EXPECT_EQ(hash_of_token("abc"), expected);
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

// Access to the metrics by the header Authorization.

constexpr const char* kMetricsToken = "the token of the metrics";

AccessSettings with_tokens(AccessMode mode, bool has_metrics_token) {
  AccessSettings settings;
  settings.mode = mode;
  settings.admin = hash_of_token(kAdminToken);
  if (has_metrics_token) settings.metrics = hash_of_token(kMetricsToken);
  return settings;
}

TEST(MetricsAccess, NeedsAToken) {
  const std::string admin(kAdminToken);
  const std::string metrics = kMetricsToken;
  const AccessSettings settings = with_tokens(AccessMode::token, true);
  for (const std::string& good : {"Bearer " + metrics, "bearer " + metrics, "Bearer " + admin}) {
    EXPECT_TRUE(may_read_metrics(settings, good)) << good;
  }
  for (const std::string& bad :
       {std::string(), std::string("Bearer"), std::string("Bearer "), std::string("Bearer x"),
        metrics, "Basic " + metrics, "Bearer " + metrics + "x", "Bearer  " + metrics,
        "Bearer " + metrics.substr(1)}) {
    EXPECT_FALSE(may_read_metrics(settings, bad)) << bad;
  }
  EXPECT_FALSE(may_read_metrics(with_tokens(AccessMode::token, false), "Bearer " + metrics));
  EXPECT_TRUE(may_read_metrics(with_tokens(AccessMode::token, false), "Bearer " + admin));
}

TEST(MetricsAccess, IsOpenWithTheServerUnlessThereIsAToken) {
  EXPECT_TRUE(may_read_metrics(with_tokens(AccessMode::open, false), ""));
  EXPECT_FALSE(may_read_metrics(with_tokens(AccessMode::open, true), ""));
  EXPECT_TRUE(may_read_metrics(with_tokens(AccessMode::open, true),
                               std::string("Bearer ") + kMetricsToken));
}

// Signed tokens of a cluster.

constexpr double kNow = 1'790'000'000;
const std::string kKey(TokenSigner::kMinKeyBytes, 'k');

TokenClaims make_claims() {
  return {TokenClaims::Kind::grant, Role::controller, "s18446744073709551615", 1'790'000'060};
}

TEST(SignedToken, HasItsContentUntilItEnds) {
  const TokenSigner signer(kKey);
  const std::string token = signer.sign(make_claims());
  EXPECT_LE(token.size(), kMaxTokenBytes);
  EXPECT_NE(signer.sign(make_claims()), token) << "two tokens differ";
  EXPECT_TRUE(TokenSigner::has_signature(token));
  EXPECT_FALSE(TokenSigner::has_signature("ABCDEFGHIJKLMNOPQRSTUV"));
  const auto claims = TokenSigner(kKey).verify(token, kNow);  // another node
  ASSERT_TRUE(claims);
  EXPECT_EQ(claims->kind, TokenClaims::Kind::grant);
  EXPECT_EQ(claims->role, Role::controller);
  EXPECT_EQ(claims->session, "s18446744073709551615");
  EXPECT_EQ(claims->ends, 1'790'000'060U);
  EXPECT_TRUE(signer.verify(token, kNow + 59.9));
  EXPECT_FALSE(signer.verify(token, kNow + 60));
  EXPECT_FALSE(TokenSigner(std::string(kKey.size(), 'l')).verify(token, kNow)) << "another key";
}

TEST(SignedToken, ATokenWithoutATimeDoesNotEnd) {
  const TokenSigner signer(kKey);
  const std::string token = signer.sign({TokenClaims::Kind::resume, Role::viewer, "s1", 0});
  const auto claims = signer.verify(token, 100 * kNow);
  ASSERT_TRUE(claims);
  EXPECT_EQ(claims->kind, TokenClaims::Kind::resume);
}

TEST(SignedToken, NoChangedTokenIsValid) {
  const TokenSigner signer(kKey);
  const std::string token = signer.sign(make_claims());
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string changed = token;
    changed[i] = changed[i] == 'A' ? 'B' : 'A';
    EXPECT_FALSE(signer.verify(changed, kNow)) << i;
    EXPECT_FALSE(signer.verify(token.substr(0, i), kNow)) << i;
  }
  EXPECT_FALSE(signer.verify(token + "A", kNow));
  EXPECT_FALSE(signer.verify(token + "=", kNow));
  EXPECT_FALSE(signer.verify("." + token, kNow));
}

}  // namespace
}  // namespace vat::test::access_test
