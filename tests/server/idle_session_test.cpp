// Work that sessions cause without commands and ticks.

#include "tests/server/session_fixture.h"

namespace vat::test::idle_session_test {
namespace {

using namespace std::chrono_literals;

class IdleSession : public SessionTest {};

// With a client that watches: statuses go on.
TEST_F(IdleSession, WakesForItsStatusesOnly) {
  client->result("frames.subscribe");
  client->wait_frame([](const GridFrame&) { return true; });
  server.clock().advance(1s);  // the first frame was acknowledged, the last beat was sent
  const std::size_t frames = client->connection->frame_count();
  const std::size_t tasks = server.clock().tasks_run();
  client->mark();
  server.clock().advance(10s);
  EXPECT_EQ(client->connection->frame_count(), frames);
  EXPECT_EQ(client->events("session.status").size(), 20U);
  EXPECT_LE(server.clock().tasks_run() - tasks, 20U + 1) << "and one check for expired sessions";
}

TEST_F(IdleSession, WithNobodyInItWakesForItsStatusesOnly) {
  client->result("session.leave");
  server.clock().advance(1s);
  const std::size_t tasks = server.clock().tasks_run();
  server.clock().advance(10s);
  EXPECT_LE(server.clock().tasks_run() - tasks, 20U + 1);
}

}  // namespace
}  // namespace vat::test::idle_session_test
