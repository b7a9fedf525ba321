// Several endpoints on one port, each with a thread of its own.

#include <mutex>
#include <set>
#include <thread>

#include "tests/server/transport_fixture.h"

namespace vat::test::transport_endpoints_test {

namespace {

/// Echoes, and notes the threads on which it is told.
class ThreadRecorder final : public ConnectionHandler {
 public:
  void opened(std::shared_ptr<Connection> connection) override {
    const std::lock_guard lock(mutex_);
    threads_.insert(std::this_thread::get_id());
    const ConnectionId id = connection->id();
    connections_[id] = {std::this_thread::get_id(), std::move(connection)};
  }
  void text_received(ConnectionId id, std::string_view message) override {
    std::shared_ptr<Connection> sender;
    {
      const std::lock_guard lock(mutex_);
      stays_ &= connections_.at(id).first == std::this_thread::get_id();
      sender = connections_.at(id).second;
    }
    sender->send_text(std::string(message));
  }
  void binary_received(ConnectionId, std::string_view) override {}
  void closed(ConnectionId id) override {
    const std::lock_guard lock(mutex_);
    stays_ &= connections_.at(id).first == std::this_thread::get_id();
    connections_.erase(id);
  }

  std::size_t thread_count() {
    const std::lock_guard lock(mutex_);
    return threads_.size();
  }
  std::size_t open_count() {
    const std::lock_guard lock(mutex_);
    return connections_.size();
  }
  /// Whether each connection has always been told of on one thread.
  bool stays() {
    const std::lock_guard lock(mutex_);
    return stays_;
  }
  std::vector<std::shared_ptr<Connection>> connections() {
    const std::lock_guard lock(mutex_);
    std::vector<std::shared_ptr<Connection>> all;
    for (const auto& [id, entry] : connections_) all.push_back(entry.second);
    return all;
  }

 private:
  std::mutex mutex_;
  std::set<std::thread::id> threads_;
  std::map<ConnectionId, std::pair<std::thread::id, std::shared_ptr<Connection>>> connections_;
  bool stays_ = true;
};

class TransportEndpointsTest : public testing::Test {
 protected:
  TransportEndpointsTest() {
    settings.port = 0;
    settings.endpoints = 3;
  }
  std::unique_ptr<Transport> make() {
    return make_websocket_transport(settings, recorder, [](std::string_view, std::string_view) {
      return HttpResponse{200, "text/plain", "here", {}};
    });
  }

  TransportSettings settings;
  ThreadRecorder recorder;
};

// The system chooses the endpoint by a hash: that 60 connections all get the same of three happens
// once in 3^59.
TEST_F(TransportEndpointsTest, ShareTheConnections) {
  const auto transport = make();
  const std::uint16_t port = transport->start();
  std::vector<std::unique_ptr<WsClient>> clients;
  for (int i = 0; i < 60; ++i) clients.push_back(std::make_unique<WsClient>(port));
  for (int i = 0; i < 60; ++i) {
    clients[i]->send_text("message " + std::to_string(i));
    EXPECT_EQ(clients[i]->read_message().payload, "message " + std::to_string(i));
  }
  EXPECT_EQ(recorder.open_count(), 60u) << "each has an id of its own";
  EXPECT_GT(recorder.thread_count(), 1u);
  EXPECT_EQ(http(port, "GET", "/").body, "here");
  transport->stop();
  EXPECT_EQ(recorder.open_count(), 0u);
  EXPECT_TRUE(recorder.stays());
}

TEST_F(TransportEndpointsTest, LimitsHoldForAllTogether) {
  settings.max_connections = 10;
  const auto transport = make();
  const std::uint16_t port = transport->start();
  std::vector<std::unique_ptr<WsClient>> clients;
  for (int i = 0; i < 10; ++i) {
    clients.push_back(std::make_unique<WsClient>(port));
    clients.back()->send_text("x");
    EXPECT_EQ(clients.back()->read_message().payload, "x");
  }
  for (int i = 0; i < 20; ++i) EXPECT_EQ(WsClient(port).read_close(), 1013);
  EXPECT_EQ(recorder.open_count(), 10u);
  transport->stop();
}

// A shared message goes out of several threads at once, and is let go when the last has sent it.
TEST_F(TransportEndpointsTest, SendOneMessageToAll) {
  const auto transport = make();
  const std::uint16_t port = transport->start();
  std::vector<std::unique_ptr<WsClient>> clients;
  for (int i = 0; i < 30; ++i) {
    clients.push_back(std::make_unique<WsClient>(port));
    clients.back()->send_text("here");
    clients.back()->read_message();
  }
  const auto bytes = std::make_shared<const std::string>(40'000, 'x');
  for (int round = 0; round < 20; ++round) {
    for (const auto& connection : recorder.connections()) connection->send_binary(bytes);
    for (const auto& client : clients) ASSERT_TRUE(client->read_message().payload == *bytes);
  }
  transport->stop();
  EXPECT_EQ(bytes.use_count(), 1);
}

// Two programs that share a port would get each other's clients.
TEST_F(TransportEndpointsTest, APortInUseIsAnErrorThatNamesIt) {
  const auto transport = make();
  settings.port = transport->start();
  const auto second = make();
  try {
    second->start();
    ADD_FAILURE() << "two servers on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), ("cannot listen on 127.0.0.1:" + std::to_string(settings.port) +
                                ": Address already in use")
                                   .c_str());
  }
  transport->stop();
}

}  // namespace

}  // namespace vat::test::transport_endpoints_test
