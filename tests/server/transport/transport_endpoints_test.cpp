// Several endpoints on one port, each with its own thread.

#include "tests/server/transport/transport_fixture.h"

namespace vat::test::transport_endpoints_test {

namespace {

class TransportEndpointsTest : public TransportTest {
 protected:
  TransportEndpointsTest() {
    settings.endpoints = 3;
    recorder.echo = true;
  }
  /// Opens `count` connections, and waits for a reply on each.
  void connect(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      clients.push_back(std::make_unique<WsClient>(port));
      const std::string message = "message " + std::to_string(i);
      clients.back()->send_text(message);
      EXPECT_EQ(clients.back()->read_message().payload, message);
    }
  }

  std::vector<std::unique_ptr<WsClient>> clients;
};

// The system chooses the endpoint by a hash. The probability that 60 connections all get the same
// of three endpoints is 3^-59.
TEST_F(TransportEndpointsTest, ShareTheConnections) {
  start();
  connect(60);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(http(port, "GET", "/page").body, "/page");
  transport->stop();
  std::set<std::thread::id> threads;
  for (const auto& [id, thread] : recorder.threads) threads.insert(thread);
  EXPECT_EQ(recorder.connections.size(), 60u) << "each connection has a different id";
  EXPECT_GT(threads.size(), 1u);
}

TEST_F(TransportEndpointsTest, LimitsHoldForAllTogether) {
  settings.max_connections = 10;
  start();
  connect(10);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(WsClient(port).read_close(), 1013);
  EXPECT_EQ(recorder.read([this] { return recorder.connections.size(); }), 10u);
  clients.pop_back();
  ASSERT_TRUE(recorder.wait_closed(1));
  connect(1);
}

// Several threads send a shared message simultaneously. It is released after the last has sent it.
TEST_F(TransportEndpointsTest, SendOneMessageToAll) {
  start();
  connect(30);
  const auto bytes = std::make_shared<const std::string>(40'000, 'x');
  for (int round = 0; round < 20; ++round) {
    for (const auto& [id, connection] : recorder.connections) connection->send_binary(bytes);
    for (const auto& client : clients) ASSERT_TRUE(client->read_message().payload == *bytes);
  }
  transport->stop();
  EXPECT_EQ(bytes.use_count(), 1);
}

}  // namespace

}  // namespace vat::test::transport_endpoints_test
