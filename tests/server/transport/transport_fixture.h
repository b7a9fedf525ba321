#pragma once

#include <gtest/gtest.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "server/transport/transport.h"
#include "tests/server/transport/transport_client.h"

namespace vat::test {

/// Records the calls of the transport. Tests wait for the expected calls.
class Recorder : public ConnectionHandler {
 public:
  struct Received {
    ConnectionId id;
    bool text;
    std::string message;
  };

  void opened(std::shared_ptr<Connection> connection) override {
    change([&] {
      const ConnectionId id = connection->id();
      threads[id] = std::this_thread::get_id();
      order_ok &= connections.emplace(id, std::move(connection)).second;
    });
  }
  void text_received(ConnectionId id, std::string_view message) override {
    if (message == "throw") throw std::runtime_error("the handler failed");
    receive(id, true, message);
  }
  void binary_received(ConnectionId id, std::string_view message) override {
    receive(id, false, message);
  }
  void closed(ConnectionId id) override {
    change([&] { order_ok &= is_known(id) && ended.insert(id).second; });
  }

  /// Returns false if `condition`, evaluated under the lock, does not become true in time.
  bool wait(const std::function<bool()>& condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, condition);
  }
  bool wait_opened(std::size_t count) {
    return wait([&] { return connections.size() >= count; });
  }
  bool wait_closed(std::size_t count) {
    return wait([&] { return ended.size() >= count; });
  }
  std::shared_ptr<Connection> connection(ConnectionId id) {
    std::lock_guard lock(mutex_);
    return connections.at(id);
  }
  template <class Read>
  auto read(Read&& read) {
    std::lock_guard lock(mutex_);
    return read();
  }

  bool echo = false;
  std::map<ConnectionId, std::shared_ptr<Connection>> connections;
  std::map<ConnectionId, std::thread::id> threads;  ///< thread on which each connection was opened
  std::set<ConnectionId> ended;
  std::vector<Received> received;
  /// Whether each connection was opened, then received messages, then closed, once and on one
  /// thread.
  bool order_ok = true;

 private:
  template <class Change>
  void change(Change&& change) {
    {
      std::lock_guard lock(mutex_);
      change();
    }
    changed_.notify_all();
  }
  bool is_known(ConnectionId id) const {
    return connections.contains(id) && threads.at(id) == std::this_thread::get_id();
  }
  void receive(ConnectionId id, bool text, std::string_view message) {
    std::shared_ptr<Connection> sender;
    change([&] {
      order_ok &= is_known(id) && !ended.contains(id);
      received.push_back({id, text, std::string(message)});
      if (echo && order_ok) sender = connections.at(id);
    });
    if (!sender) return;
    if (text) {
      sender->send_text(std::string(message));
    } else {
      sender->send_binary(std::make_shared<const std::string>(message));
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
};

class TransportTest : public testing::Test {
 protected:
  TransportTest() { settings.port = 0; }

  void start() {
    settings.report = [this](std::string_view fault) {
      std::lock_guard lock(faults_mutex_);
      faults_.emplace_back(fault);
    };
    transport = make_websocket_transport(
        settings, recorder, [this](const HttpRequest& request) { return http_handler(request); });
    port = transport->start();
  }
  void TearDown() override {
    if (transport) transport->stop();
    EXPECT_TRUE(recorder.order_ok);
    EXPECT_EQ(recorder.connections.size(), recorder.ended.size()) << "opened without closed";
    EXPECT_EQ(faults(), expected_faults);
  }
  std::vector<std::string> faults() {
    std::lock_guard lock(faults_mutex_);
    return faults_;
  }

  TransportSettings settings;
  Recorder recorder;
  HttpHandler http_handler = [](const HttpRequest& request) {
    return HttpResponse{200, "text/plain", std::string(request.target), {}};
  };
  std::vector<std::string> expected_faults;
  std::unique_ptr<Transport> transport;
  std::uint16_t port = 0;

 private:
  std::mutex faults_mutex_;
  std::vector<std::string> faults_;
};

}  // namespace vat::test
