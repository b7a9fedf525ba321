// A disk that becomes full.

#include <gtest/gtest.h>

#include "server/script/server_process.h"
#include "tests/recovery/client.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::disk_test {
namespace {

TEST(Disk, OneThatFillsUpRefusesCommandsAndLosesNothing) {
  const TemporaryFolder folder;
  const std::string serve = "exec '" VAT_PROGRAM
                            "' serve --port 0 --scene rigid-stack --log-level error --data '" +
                            folder.file("data") + "'";
  std::string hash;
  {
    // No file may exceed 600 kB. Without the trap, the system would end the program.
    script::ServerProcess server("/bin/sh", {"-c", "trap '' XFSZ; ulimit -f 1200; " + serve});
    WaitingClient client(server.port());
    client.result("session.join");
    client.result("control.pause");
    Json reply;
    for (int i = 0; i < 5000 && !reply.contains("error"); ++i) {
      hash = client.result("session.hash").at("hash");
      reply = client.call("world.apply_force",
                          {{"body", 1}, {"force", {0, 0, 1e-6 * i}}, {"duration", 1e-3}});
      if (i % 50 == 49) client.result("control.reset");  // too many simultaneous forces are refused
    }
    ASSERT_TRUE(reply.contains("error"));
    EXPECT_EQ(reply.at("error").at("data").at("kind"), "storage_failed") << reply;
    EXPECT_EQ(client.result("session.hash").at("hash"), hash) << "the command was executed";
  }
  script::ServerProcess server("/bin/sh", {"-c", serve});
  WaitingClient client(server.port());
  client.result("session.join");
  EXPECT_EQ(client.result("session.hash").at("hash"), hash);
  client.result("world.set_gravity", {{"gravity", {0, 0, -1}}});
}

}  // namespace
}  // namespace vat::test::disk_test
