// What /readyz says of a server whose sessions are still to come back.

#include <gtest/gtest.h>

#include <chrono>
#include <iostream>
#include <thread>

#include "server/script/http_fetch.h"
#include "server/script/server_process.h"
#include "tests/recovery/client.h"
#include "tests/support/pool_scene.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::ready_test {
namespace {

using namespace std::chrono_literals;
using std::chrono::steady_clock;

Json fetch_readiness(std::uint16_t port) {
  const auto url = script::read_websocket_url("ws://127.0.0.1:" + std::to_string(port) + "/ws");
  return script::fetch_http(url, {}, "/readyz", steady_clock::now() + 30s);
}

TEST(Readiness, IsToldOnceAllSessionsAreBack) {
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
    server.kill();  // without a checkpoint at its end
  }
  script::ServerProcess server = start();
  int waited = 0;
  for (const auto end = steady_clock::now() + 120s; steady_clock::now() < end; ++waited) {
    const Json readiness = fetch_readiness(server.port());
    if (readiness.at("status") == 200) break;
    EXPECT_EQ(readiness.at("status"), 503);
    std::this_thread::sleep_for(10ms);
  }
  ASSERT_EQ(fetch_readiness(server.port()).at("status"), 200);
  std::cout << "ready after it was asked " << waited << " times\n";
  WaitingClient client(server.port());
  const Json listed = client.result("session.list").at("sessions");
  ASSERT_EQ(listed.size(), 1U);
  EXPECT_EQ(listed[0].at("state"), "running");
}

}  // namespace
}  // namespace vat::test::ready_test
