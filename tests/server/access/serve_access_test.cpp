// Access by the options of `vat serve`: the mode, and secrets in files and variables.

#include "server/cli/serve/serve_access.h"

#include <gtest/gtest.h>

#include <functional>

#include "server/access/signed_token.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::serve_access_test {
namespace {

constexpr const char* kVariable = "VAT_ADMIN_TOKEN";
constexpr const char* kKeyVariable = "VAT_CLUSTER_KEY";
constexpr const char* kToken = "0123456789abcdef";  // the minimum length
const std::string kKey(TokenSigner::kMinKeyBytes, 'k');

class ServeAccessTest : public testing::Test {
 protected:
  ServeAccessTest() { unset(); }
  void TearDown() override { unset(); }
  static void unset() {
    unsetenv(kVariable);
    unsetenv(kKeyVariable);
  }

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
  settings.trusted_proxy.clear();
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
  EXPECT_EQ(made().settings.admin, hash_of_token(kToken)) << "also works in open mode";
}

TEST_F(ServeAccessTest, AClusterNeedsAKeyForAccessByToken) {
  settings.access = "token";
  EXPECT_EQ(made().cluster_key, "");
  settings.cluster.servers = {"nats://127.0.0.1:4222"};
  EXPECT_EQ(refusal(), "missing");
  settings.access = "open";
  EXPECT_EQ(made().cluster_key, "");
  setenv(kKeyVariable, kKey.c_str(), 1);
  EXPECT_EQ(made().cluster_key, kKey);
}

TEST_F(ServeAccessTest, ASecretIsTheFirstLineOfItsFile) {
  setenv(kVariable, "another token of the admin", 1);  // a file precedes its variable
  setenv(kKeyVariable, kKey.c_str(), 1);
  settings.cluster.servers = {"nats://127.0.0.1:4222"};
  struct Secret {
    std::string& file;
    std::string shortest;
    std::function<bool(const ServeAccess&)> is_read;
  };
  const TokenHash token = hash_of_token(kToken);
  const std::string key(TokenSigner::kMinKeyBytes, 'f');
  const Secret secrets[] = {
      {settings.admin_token_file, kToken, [&](auto& made) { return made.settings.admin == token; }},
      {settings.metrics_token_file, kToken,
       [&](auto& made) { return made.settings.metrics == token; }},
      {settings.cluster.key_file, key, [&](auto& made) { return made.cluster_key == key; }}};
  for (const auto& [file, shortest, is_read] : secrets) {
    SCOPED_TRACE(shortest);
    file = folder.file("secret");
    folder.write("secret", shortest + "\nnot this\n");
    EXPECT_TRUE(is_read(made()));
    folder.write("secret", shortest.substr(1) + "\n");
    EXPECT_EQ(refusal(), "out_of_range");
    folder.write("secret", "");
    EXPECT_EQ(refusal(), "unreadable_file");
    file = folder.file("missing");
    EXPECT_EQ(refusal(), "unreadable_file");
    file.clear();
  }
}

TEST_F(ServeAccessTest, AVariableWithAWeakTokenIsRefused) {
  for (const char* weak : {"0123456789abcde", ""}) {
    setenv(kVariable, weak, 1);
    EXPECT_EQ(refusal(), "out_of_range") << weak;
  }
}

}  // namespace
}  // namespace vat::test::serve_access_test
