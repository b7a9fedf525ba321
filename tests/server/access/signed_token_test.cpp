#include "server/access/signed_token.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "server/cli/serve/serve_access.h"
#include "server/messages/limits.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::signed_token_test {
namespace {

constexpr double kNow = 1'790'000'000;
const std::string kKey(TokenSigner::kMinKeyBytes, 'k');

TokenClaims make_claims() {
  return {TokenClaims::Kind::grant, Role::controller, "s18446744073709551615", 1'790'000'060};
}

TEST(SignedToken, HasItsContentUntilItEnds) {
  const TokenSigner signer(kKey);
  const std::string token = signer.sign(make_claims());
  EXPECT_LE(token.size(), kMaxTokenBytes);
  const auto claims = TokenSigner(kKey).verify(token, kNow);  // another node
  ASSERT_TRUE(claims);
  EXPECT_EQ(claims->kind, TokenClaims::Kind::grant);
  EXPECT_EQ(claims->role, Role::controller);
  EXPECT_EQ(claims->session, "s18446744073709551615");
  EXPECT_EQ(claims->ends, 1'790'000'060U);
  EXPECT_TRUE(signer.verify(token, kNow + 59.9));
  EXPECT_FALSE(signer.verify(token, kNow + 60));
}

TEST(SignedToken, ATokenWithoutATimeDoesNotEnd) {
  const TokenSigner signer(kKey);
  const std::string token = signer.sign({TokenClaims::Kind::resume, Role::viewer, "s1", 0});
  const auto claims = signer.verify(token, 100 * kNow);
  ASSERT_TRUE(claims);
  EXPECT_EQ(claims->kind, TokenClaims::Kind::resume);
}

TEST(SignedToken, TwoTokensDiffer) {
  const TokenSigner signer(kKey);
  EXPECT_NE(signer.sign(make_claims()), signer.sign(make_claims()));
}

TEST(SignedToken, AnotherKeyRefusesIt) {
  const std::string token = TokenSigner(kKey).sign(make_claims());
  EXPECT_FALSE(TokenSigner(std::string(kKey.size(), 'l')).verify(token, kNow));
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

TEST(SignedToken, OnlyATokenOfTwoPartsCanBeSigned) {
  EXPECT_FALSE(TokenSigner::has_signature("ABCDEFGHIJKLMNOPQRSTUV"));
  EXPECT_TRUE(TokenSigner::has_signature(TokenSigner(kKey).sign(make_claims())));
}

class ClusterKey : public testing::Test {
 protected:
  ClusterKey() {
    unsetenv("VAT_CLUSTER_KEY");
    settings.access = "token";
    settings.cluster.servers = {"nats://127.0.0.1:4222"};
  }
  ~ClusterKey() override { unsetenv("VAT_CLUSTER_KEY"); }
  std::string refusal() const {
    const Result<ServeAccess> access = serve_access(settings);
    return access ? "" : access.errors().front().code;
  }

  const TemporaryFolder folder;
  ServeSettings settings;
};

TEST_F(ClusterKey, IsNeededForAccessByToken) {
  EXPECT_EQ(refusal(), "missing");
  settings.access = "open";
  EXPECT_EQ(serve_access(settings).value().cluster_key, "");
  settings.access = "token";
  settings.cluster.servers.clear();
  EXPECT_EQ(serve_access(settings).value().cluster_key, "");
}

TEST_F(ClusterKey, IsTheFirstLineOfAFileOrAVariable) {
  setenv("VAT_CLUSTER_KEY", kKey.c_str(), 1);
  EXPECT_EQ(serve_access(settings).value().cluster_key, kKey);
  const std::string other(TokenSigner::kMinKeyBytes, 'f');
  folder.write("key", other + "\nnot this\n");
  settings.cluster.key_file = folder.file("key");
  EXPECT_EQ(serve_access(settings).value().cluster_key, other);
}

TEST_F(ClusterKey, MustBeLong) {
  folder.write("key", kKey.substr(1) + "\n");
  settings.cluster.key_file = folder.file("key");
  EXPECT_EQ(refusal(), "out_of_range");
  settings.cluster.key_file = folder.file("missing");
  EXPECT_EQ(refusal(), "unreadable_file");
}

}  // namespace
}  // namespace vat::test::signed_token_test
