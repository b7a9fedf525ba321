#pragma once

#include <boost/asio/ip/address.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <websocketpp/concurrency/none.hpp>
#include <websocketpp/config/asio_no_tls.hpp>
#include <websocketpp/logger/stub.hpp>
#include <websocketpp/server.hpp>

#include "server/transport/transport.h"
#include "server/transport/ws_message.h"
#include "server/transport/ws_socket.h"
#include "server/transport/ws_upgrade.h"

namespace vat {

class WsConnection;

/// Data of the transport in each websocketpp connection.
struct WsPeer {
  ConnectionId id = 0;  ///< 0: no open WebSocket
  std::shared_ptr<WsConnection> peer;
  std::shared_ptr<void> socket_slot;        ///< counts the open sockets
  boost::asio::ip::address socket_address;  ///< unspecified if the peer has disconnected
  std::string address;                      ///< see Connection::address()
  std::shared_ptr<void> address_slot;       ///< counts the sockets of the address
  std::shared_ptr<void> peer_slot;          ///< counts the WebSockets of the address
  std::weak_ptr<void> unsent_pong;
  std::optional<boost::asio::steady_timer> response_deadline;
  int unanswered_pings = 0;
};

/// HTTP request that counts the bytes received after its end. The library handles every upgrade as
/// RFC 6455, and refuse_upgrade() decides on the version that the client sent. Otherwise the
/// library would answer requests of the drafts before the RFC with status 500.
struct WsRequest : websocketpp::http::parser::request {
  std::size_t consume(const char* bytes, std::size_t size) {
    const std::size_t used = websocketpp::http::parser::request::consume(bytes, size);
    rest = size - used;
    if (ready()) {
      websocket_version = get_header("Sec-WebSocket-Version");
      replace_header("Sec-WebSocket-Version", kWebSocketVersion);
    }
    return used;
  }
  std::size_t rest = 0;
  std::string websocket_version;  // empty if the client sent none
};

/// Configuration of websocketpp for one thread: no locks, log or compression.
struct WsConfig : websocketpp::config::asio {
  using type = WsConfig;
  using base = websocketpp::config::asio;
  using concurrency_type = websocketpp::concurrency::none;
  using message_type = WsMessage;
  using con_msg_manager_type = WsMessage::Manager;
  using endpoint_msg_manager_type =
      websocketpp::message_buffer::alloc::endpoint_msg_manager<con_msg_manager_type>;
  using elog_type = websocketpp::log::stub;
  using alog_type = websocketpp::log::stub;
  using connection_base = WsPeer;
  using request_type = WsRequest;
  static constexpr bool enable_multithreading = false;

  struct transport_config : base::transport_config {
    using concurrency_type = type::concurrency_type;
    using elog_type = type::elog_type;
    using alog_type = type::alog_type;
    using request_type = type::request_type;
    using response_type = type::response_type;
    using socket_type = WsSocketEndpoint;
    static constexpr bool enable_multithreading = false;
    static constexpr long timeout_socket_shutdown = 1000;  // [ms]
  };
  using transport_type = websocketpp::transport::asio::endpoint<transport_config>;
};

using WsServer = websocketpp::server<WsConfig>;
using WsStream = WsServer::connection_type;  ///< TCP connection with WebSocket or HTTP

}  // namespace vat
