// Access to the metrics by the header Authorization.

#include <gtest/gtest.h>

#include <cstdlib>

#include "server/access/access.h"
#include "server/cli/serve/serve_access.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::metrics_access_test {
namespace {

constexpr const char* kAdminToken = "the token of the admin";
constexpr const char* kMetricsToken = "the token of the metrics";

AccessSettings access(AccessMode mode, bool has_metrics_token) {
  AccessSettings settings;
  settings.mode = mode;
  settings.admin = hash_of_token(kAdminToken);
  if (has_metrics_token) settings.metrics = hash_of_token(kMetricsToken);
  return settings;
}

TEST(MetricsAccess, NeedsAToken) {
  const std::string admin = kAdminToken;
  const std::string metrics = kMetricsToken;
  const AccessSettings settings = access(AccessMode::token, true);
  for (const std::string& good : {"Bearer " + metrics, "bearer " + metrics, "Bearer " + admin}) {
    EXPECT_TRUE(may_read_metrics(settings, good)) << good;
  }
  for (const std::string& bad :
       {std::string(), std::string("Bearer"), std::string("Bearer "), std::string("Bearer x"),
        metrics, "Basic " + metrics, "Bearer " + metrics + "x", "Bearer  " + metrics,
        "Bearer " + metrics.substr(1)}) {
    EXPECT_FALSE(may_read_metrics(settings, bad)) << bad;
  }
  EXPECT_FALSE(may_read_metrics(access(AccessMode::token, false), "Bearer " + metrics));
  EXPECT_TRUE(may_read_metrics(access(AccessMode::token, false), "Bearer " + admin));
}

TEST(MetricsAccess, IsOpenWithTheServerUnlessThereIsAToken) {
  EXPECT_TRUE(may_read_metrics(access(AccessMode::open, false), ""));
  EXPECT_FALSE(may_read_metrics(access(AccessMode::open, true), ""));
  EXPECT_TRUE(
      may_read_metrics(access(AccessMode::open, true), std::string("Bearer ") + kMetricsToken));
}

TEST(MetricsAccess, TheTokenIsTheFirstLineOfAFile) {
  const TemporaryFolder folder;
  folder.write("token", std::string(kMetricsToken) + "\nnot this\n");
  folder.write("short", "0123456789abcde\n");
  ServeSettings settings;
  settings.metrics_token_file = folder.file("token");
  const Result<ServeAccess> read = serve_access(settings);
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read.value().settings.metrics, hash_of_token(kMetricsToken));
  settings.metrics_token_file = folder.file("short");
  EXPECT_EQ(serve_access(settings).errors().front().code, "out_of_range");
  settings.metrics_token_file = folder.file("none");
  EXPECT_EQ(serve_access(settings).errors().front().code, "unreadable_file");
}

}  // namespace
}  // namespace vat::test::metrics_access_test
