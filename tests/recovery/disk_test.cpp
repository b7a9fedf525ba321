// Unusable data folders, and disks that become full.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>

#include "server/script/server_process.h"
#include "server/storage/data_folder.h"
#include "tests/recovery/client.h"
#include "tests/support/temporary_folder.h"

namespace vat::test::disk_test {
namespace {

using testing::HasSubstr;

struct Ended {
  int status = -1;
  std::string output;
};

/// Runs a server that must fail to start.
Ended run_server(const std::string& data) {
  const std::string command =
      "'" VAT_PROGRAM "' serve --port 0 --scene rigid-stack --data '" + data + "' 2>&1";
  Ended ended;
  std::FILE* pipe = popen(command.c_str(), "r");
  char line[512];
  while (std::fgets(line, sizeof line, pipe) != nullptr) ended.output += line;
  ended.status = WEXITSTATUS(pclose(pipe));
  return ended;
}

TEST(Disk, DataThatCannotBeUsedEndsTheServerAtItsStart) {
  const TemporaryFolder folder;
  folder.write("garbage/vat.db", std::string(5000, 'x'));
  const Ended garbage = run_server(folder.file("garbage"));
  EXPECT_EQ(garbage.status, 1);
  EXPECT_THAT(garbage.output, HasSubstr("garbage/vat.db: file is not a database"));

  const DataFolder used(folder.file("used"));
  const Ended locked = run_server(folder.file("used"));
  EXPECT_EQ(locked.status, 1);
  EXPECT_THAT(locked.output, HasSubstr("used is used by another server"));

  const Ended read_only = run_server("/proc/vat");  // not writable, even for root
  EXPECT_EQ(read_only.status, 1);
  EXPECT_THAT(read_only.output, HasSubstr("/proc/vat cannot be written"));
}

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
