#pragma once

#include <boost/asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/net/ws_server.h"

namespace vat {

/// What other threads want done with the connections of an endpoint, carried out by its thread in
/// the order of the calls. Calls that come faster than the thread takes them make one task of it,
/// so that a frame for a thousand clients wakes it once. Safe to use from any thread.
class WsLane : public std::enable_shared_from_this<WsLane> {
 public:
  explicit WsLane(boost::asio::io_context& io) : io_(&io) {}

  void send(std::weak_ptr<WsStream> stream, WsMessage::ptr message);
  void close(std::weak_ptr<WsStream> stream, std::uint16_t code, std::string reason);
  /// Lets go of all that is left and does nothing from now on: the endpoint has ended.
  void shut();

 private:
  struct Task {
    std::weak_ptr<WsStream> stream;
    WsMessage::ptr message;  // null: close
    std::uint16_t code = 0;
    std::string reason;
  };
  void put(Task task);
  void carry_out_all();

  std::mutex mutex_;
  boost::asio::io_context* io_;  // null once shut
  std::vector<Task> tasks_;
};

/// Begins the closing handshake; drops the connection where that is not possible. Endpoint's
/// thread only.
void close_stream(WsStream& stream, std::uint16_t code, const std::string& reason);

}  // namespace vat
