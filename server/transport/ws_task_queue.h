#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/transport/ws_server.h"

namespace vat {

/// Queue of sends, closes and HTTP responses from other threads. The endpoint's thread executes the
/// tasks in order. All tasks that arrive before the thread runs wake the thread only once, for
/// example for a frame to a thousand clients. Thread-safe.
class WsTaskQueue : public std::enable_shared_from_this<WsTaskQueue> {
 public:
  explicit WsTaskQueue(boost::asio::io_context& io) : io_(&io) {}

  void send(std::weak_ptr<WsStream> stream, WsMessage::ptr message);
  void close(std::weak_ptr<WsStream> stream, std::uint16_t code, std::string reason);
  /// Calls `work` with the stream, if the stream exists. `work` must not throw.
  void run(std::weak_ptr<WsStream> stream,
           std::function<void(const std::shared_ptr<WsStream>&)> work);
  /// Drops all tasks, because the endpoint has ended. Later calls have no effect.
  void shut();

 private:
  struct Task {
    std::weak_ptr<WsStream> stream;
    WsMessage::ptr message;  // null: run `work`, or close the connection
    std::uint16_t code = 0;
    std::string reason;
    std::function<void(const std::shared_ptr<WsStream>&)> work;
  };
  void put(Task task);
  void run_all();

  std::mutex mutex_;
  boost::asio::io_context* io_;  // null after shut()
  std::vector<Task> tasks_;
};

/// Starts the closing handshake, or drops the connection if a handshake is not possible. Must be
/// called on the endpoint's thread.
void close_stream(WsStream& stream, std::uint16_t code, const std::string& reason);

}  // namespace vat
