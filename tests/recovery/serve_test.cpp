// The start and the end of a process `vat serve`.

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <future>

#include "server/script/http_fetch.h"
#include "server/script/server_process.h"
#include "tests/recovery/client.h"
#include "tests/support/pool_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace vat::test::serve_test {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

class Serve : public testing::Test {
 protected:
  Serve() { folder.write("pool.json", kPoolScene); }
  script::ServerProcess start(const std::string& option, const std::string& value) {
    return {VAT_PROGRAM,
            {"serve", "--port", "0", "--scenes", folder.path().string(), "--scene", "pool",
             "--data", folder.file("data"), "--log-level", "error", option, value}};
  }
  const TemporaryFolder folder;
};

TEST_F(Serve, UnusableDataEndsTheProcessAtItsStart) {
  folder.write("data/vat.db", std::string(5000, 'x'));
  const std::string command = "'" VAT_PROGRAM "' serve --port 0 --scene rigid-stack --data '" +
                              folder.file("data") + "' 2>&1";
  std::string output;
  std::FILE* pipe = popen(command.c_str(), "r");
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) output += line;
  EXPECT_EQ(WEXITSTATUS(pclose(pipe)), 1);
  EXPECT_THAT(output, testing::HasSubstr("data/vat.db: file is not a database"));
}

TEST_F(Serve, ReadinessIsReportedAfterAllRecoveries) {
  {
    script::ServerProcess server = start("--checkpoint-seconds", "3600");
    WaitingClient client(server.port());
    client.result("session.join");
    client.result("control.pause");
    for (int i = 0; i < 20; ++i) client.result("control.step", {{"ticks", 50}});
    server.kill();  // without a final checkpoint
  }
  script::ServerProcess server = start("--checkpoint-seconds", "3600");
  const auto url =
      client::read_websocket_url("ws://127.0.0.1:" + std::to_string(server.port()) + "/ws");
  const auto is_ready = [&] {
    const Json reply = script::fetch_http(url, {}, "/readyz", steady_clock::now() + 30s);
    EXPECT_TRUE(reply.at("status") == 200 || reply.at("status") == 503) << reply;
    return reply.at("status") == 200;
  };
  ASSERT_TRUE(wait_until(is_ready, 120s));
  const Json listed = WaitingClient(server.port()).result("session.list").at("sessions");
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0].at("state"), "running");
}

TEST_F(Serve, SigtermNotifiesClientsAndEndsTheProcessAfterTheLast) {
  script::ServerProcess server = start("--drain-seconds", "3000");
  WaitingClient client(server.port());
  client.result("session.join");
  auto status = std::async(std::launch::async, [&] { return server.stop(); });
  EXPECT_EQ(client.wait("server.draining").at("params").at("seconds"), 3000);
  client.result("control.step", {{"ticks", 3}});  // connected clients continue
  client.close();
  EXPECT_EQ(status.get(), 0);  // long before the time limit
}

TEST_F(Serve, AnAdminEndsTheProcess) {
  constexpr const char* kToken = "the admin token of the test";
  setenv("VAT_ADMIN_TOKEN", kToken, 1);
  script::ServerProcess server = start("--drain-seconds", "30");
  unsetenv("VAT_ADMIN_TOKEN");
  WaitingClient client(server.port());
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
}  // namespace vat::test::serve_test
