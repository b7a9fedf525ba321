// Who is let in by what `vat serve` is told.

#include "server/cli/serve_access.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/temporary_folder.h"

namespace vat::test::serve_access_test {
namespace {

constexpr const char* kVariable = "VAT_ADMIN_TOKEN";
constexpr const char* kToken = "0123456789abcdef";  // of the least length

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

TEST_F(ServeAccessTest, IsOpenOnTheMachinesOwnAddressesOnly) {
  for (const char* host : {"127.0.0.1", "127.3.2.1", "::1"}) {
    settings.host = host;
    EXPECT_EQ(made().settings.mode, AccessMode::open) << host;
  }
  for (const char* host : {"0.0.0.0", "::", "10.0.0.1"}) {
    settings.host = host;
    EXPECT_EQ(made().settings.mode, AccessMode::token) << host;
  }
  settings.access = "open";
  EXPECT_EQ(made().settings.mode, AccessMode::open);
  settings.host = "127.0.0.1";
  settings.access = "token";
  EXPECT_EQ(made().settings.mode, AccessMode::token);
}

TEST_F(ServeAccessTest, MakesAnAdminsTokenWhereOneIsNeededAndNotGiven) {
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
  EXPECT_EQ(made().settings.admin, hash_of_token(kToken)) << "an admin is one in open mode too";
}

TEST_F(ServeAccessTest, TakesTheFirstLineOfAFileBeforeTheVariable) {
  setenv(kVariable, "another token of the admin", 1);
  folder.write("token", std::string(kToken) + "\nnot this\n");
  settings.admin_token_file = folder.file("token");
  EXPECT_EQ(made().settings.admin, hash_of_token(kToken));
}

TEST_F(ServeAccessTest, RefusesWhatCannotBeReadOrGuessesWouldFind) {
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
}  // namespace vat::test::serve_access_test
