// The limit of all clients' queues.

#include "server/directory/client_registry.h"
#include "tests/server/fixture/session_fixture.h"

namespace vat::test::queue_limit_test {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kCost = ControlQueue::kMessageCost;

/// JSON text of `bytes` bytes.
std::string make_json_text(std::size_t bytes) {
  return '"' + std::string(bytes - 2, 'x') + '"';
}

class QueueLimit : public testing::Test {
 protected:
  QueueLimit() { mutex.lock(); }
  ~QueueLimit() override { mutex.unlock(); }
  /// Adds a client that reads nothing.
  ClientOutbox& add() {
    connections.push_back(std::make_shared<FakeConnection>(connections.size() + 1));
    connections.back()->stall(true);
    return *clients.add(std::make_shared<ClientOutbox>(connections.back())).outbox;
  }
  std::vector<bool> closed() const {
    std::vector<bool> are_closed;
    for (const auto& connection : connections) {
      are_closed.push_back(connection->close_code() == std::uint16_t{4008});
    }
    return are_closed;
  }

  OwnedMutex mutex;
  ClientRegistry clients{mutex};
  std::vector<std::shared_ptr<FakeConnection>> connections;
};

TEST_F(QueueLimit, ClosesTheLongestQueuesBeyondTheLimit) {
  for (const std::size_t bytes : {1000U, 5000U, 2000U}) add().send(make_json_text(bytes));
  const std::size_t all = 8000 + 3 * kCost;
  EXPECT_EQ(clients.queue_bytes(), all);
  EXPECT_EQ(clients.bound_queues(all), 0U) << "at the limit";
  EXPECT_EQ(clients.bound_queues(all - 1), 1U);
  EXPECT_EQ(closed(), (std::vector{false, true, false}));
  EXPECT_EQ(clients.queue_bytes(), 3000 + 2 * kCost);
}

// Closing clients that wait for one shared text would release nothing.
TEST_F(QueueLimit, SparesClientsThatShareALongText) {
  constexpr std::size_t kSharers = 50;
  const auto text = std::make_shared<const std::string>(make_json_text(100'000));
  for (std::size_t i = 0; i < kSharers; ++i) add().send({}, text);
  for (int i = 0; i < 10; ++i) add().send(make_json_text(50'000));
  EXPECT_EQ(clients.bound_queues(100'000 + kSharers * kCost + 3 * (50'000 + kCost)), 7U);
  const std::vector<bool> are_closed = closed();
  for (std::size_t i = 0; i < kSharers; ++i) EXPECT_FALSE(are_closed[i]) << i;
}

class ServedQueues : public SessionTest {
 protected:
  static constexpr std::size_t kMostBytes = 1024 * 1024;
  ServedQueues() : SessionTest(limits()) {}
  static ServerLimits limits() {
    ServerLimits limits = unhurried_limits();
    limits.max_queue_bytes_in_all = kMostBytes;
    return limits;
  }
};

TEST_F(ServedQueues, AreCheckedEverySecond) {
  const auto fill = [](TestClient& reader, std::size_t bytes) {
    reader.connection->stall(true);
    while (reader.connection->queued() < bytes) reader.send("server.info");
  };
  const auto slow = connect();
  const auto slower = connect();
  fill(*slow, kMostBytes / 2);
  fill(*slower, kMostBytes * 3 / 4);
  EXPECT_FALSE(has_sample(server.metrics(), "vat_memory_bytes{use=\"queues\"} 0"));
  client->result("session.list");
  EXPECT_FALSE(slower->connection->close_code().has_value());
  server.clock().advance(1s);
  client->result("session.list");
  EXPECT_FALSE(slow->connection->close_code().has_value());
  EXPECT_EQ(slower->connection->close_code(), 4008);
  EXPECT_EQ(slower->connection->close_reason(), "too slow: the queues of all clients are full");
  EXPECT_TRUE(has_sample(server.metrics(), "vat_refused_total{limit=\"queue_bytes_in_all\"} 1"));
}

}  // namespace
}  // namespace vat::test::queue_limit_test
