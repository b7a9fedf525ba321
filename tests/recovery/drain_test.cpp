// The effect of SIGTERM on a server in use.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <future>

#include "server/script/server_process.h"
#include "tests/recovery/client.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace vat::test::drain_test {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

class Drain : public testing::Test {
 protected:
  script::ServerProcess start(const std::string& seconds) {
    return {VAT_PROGRAM,
            {"serve", "--port", "0", "--scene", "rigid-stack", "--data", folder.file("data"),
             "--drain-seconds", seconds, "--log-level", "error"}};
  }
  const TemporaryFolder folder;
};

TEST_F(Drain, NotifiesClientsRefusesNewOnesAndEndsAfterTheLast) {
  std::string hash;
  {
    script::ServerProcess server = start("3000");
    WaitingClient client(server.port());
    client.result("session.join");
    client.result("control.step", {{"ticks", 5}});
    auto status = std::async(std::launch::async, [&] { return server.stop(); });
    EXPECT_EQ(client.wait("server.draining").at("params").at("seconds"), 3000);
    const Json refused = client.call("session.create", {{"name", "n"}, {"scene", "rigid-stack"}});
    EXPECT_EQ(refused.at("error").at("data").at("kind"), "not_allowed");
    WaitingClient late(server.port());
    EXPECT_TRUE(!late.is_connected() || late.wait(0).at("closed") == 1013);
    client.result("control.step", {{"ticks", 3}});  // connected clients continue
    hash = client.result("session.hash").at("hash");
    client.close();
    EXPECT_EQ(status.get(), 0);  // long before the time limit
  }
  script::ServerProcess server = start("0");
  WaitingClient client(server.port());
  client.result("session.join");
  EXPECT_EQ(client.result("session.hash").at("hash"), hash);
}

TEST_F(Drain, AnAdminEndsTheServerAsWell) {
  constexpr const char* kToken = "the admin token of the test";
  setenv("VAT_ADMIN_TOKEN", kToken, 1);
  script::ServerProcess server = start("30");
  unsetenv("VAT_ADMIN_TOKEN");
  WaitingClient client(server.port());
  client.result("session.join");
  EXPECT_EQ(client.call("server.drain").at("error").at("data").at("least_role"), "admin");
  client.result("access.enter", {{"token", kToken}});
  const auto begin = steady_clock::now();
  EXPECT_EQ(client.result("server.drain", {{"seconds", 1}}).at("seconds"), 1);
  EXPECT_EQ(client.wait("server.draining").at("params").at("seconds"), 1);
  EXPECT_EQ(client.wait(0).at("closed"), 1001);
  EXPECT_GE(steady_clock::now() - begin, 1s);
  ASSERT_TRUE(wait_until([&] { return !server.is_running(); }));
  EXPECT_EQ(server.stop(), 0);
}

}  // namespace
}  // namespace vat::test::drain_test
