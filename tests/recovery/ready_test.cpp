// The reply of /readyz while sessions are being recovered.

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>

#include "server/script/http_fetch.h"
#include "server/script/server_process.h"
#include "tests/recovery/client.h"
#include "tests/support/pool_scene.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/wait.h"

namespace vat::test::ready_test {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

Json fetch_readiness(std::uint16_t port) {
  const auto url = client::read_websocket_url("ws://127.0.0.1:" + std::to_string(port) + "/ws");
  return script::fetch_http(url, {}, "/readyz", steady_clock::now() + 30s);
}

TEST(Readiness, IsReportedAfterAllRecoveries) {
  TemporaryFolder folder;
  folder.write("pool.json", kPoolScene);
  const auto start = [&]() -> script::ServerProcess {
    return {
        VAT_PROGRAM,
        {"serve", "--port", "0", "--scenes", folder.path().string(), "--scene", "pool", "--data",
         folder.file("data"), "--checkpoint-seconds", "3600", "--log-level", "error"}};
  };
  {
    script::ServerProcess server = start();
    WaitingClient client(server.port());
    client.result("session.join");
    client.result("control.pause");
    for (int i = 0; i < 20; ++i) client.result("control.step", {{"ticks", 50}});
    server.kill();  // without a final checkpoint
  }
  script::ServerProcess server = start();
  int waited = 0;
  const auto is_ready = [&] {
    const Json status = fetch_readiness(server.port()).at("status");
    if (status == 200) return true;
    ++waited;
    EXPECT_EQ(status, 503);
    return false;
  };
  ASSERT_TRUE(wait_until(is_ready, 120s));
  std::cout << "ready after " << waited << " refusals\n";
  WaitingClient client(server.port());
  const Json listed = client.result("session.list").at("sessions");
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0].at("state"), "running");
}

}  // namespace
}  // namespace vat::test::ready_test
