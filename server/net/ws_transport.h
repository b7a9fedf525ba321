#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "server/net/transport.h"
#include "server/net/ws_server.h"

namespace vat {

/// The transport on websocketpp: one endpoint, one thread that alone calls the library.
class WsTransport final : public Transport {
 public:
  WsTransport(TransportSettings settings, ConnectionHandler& connections, HttpHandler http);
  ~WsTransport() override;

  std::uint16_t start() override;
  void stop() override;

 private:
  using Handle = websocketpp::connection_hdl;
  using StreamPtr = std::shared_ptr<WsStream>;

  void configure();
  void set_handlers();
  void listen();
  void run();
  void forget_all();

  void accepted(WsStream& stream);
  bool validate(WsStream& stream);
  void opened(const StreamPtr& stream);
  void received(WsStream& stream, const WsMessage& message);
  void answer_ping(WsStream& stream, const std::string& payload);
  void closed(WsStream& stream);
  void answer_http(const StreamPtr& stream);
  HttpResponse ask_http_handler(const WsStream& stream);

  void start_pings();
  void ping_all();
  void begin_stop();
  std::vector<StreamPtr> open_streams() const;

  StreamPtr stream_of(const Handle& handle);
  template <class Work>
  bool guarded(const char* place, Work&& work) noexcept;
  void report(const char* place, const char* fault) noexcept;

  TransportSettings settings_;
  ConnectionHandler& connections_;
  HttpHandler http_;
  /// Shared with the connections, which may outlive the transport.
  std::shared_ptr<boost::asio::io_context> io_;
  WsServer server_;
  boost::asio::steady_timer ping_timer_;
  boost::asio::steady_timer stop_timer_;
  std::thread thread_;

  // The transport's thread only, once it runs.
  std::unordered_map<ConnectionId, std::weak_ptr<WsStream>> open_;
  std::shared_ptr<std::size_t> socket_count_;
  ConnectionId last_id_ = 0;
  bool stopping_ = false;
};

}  // namespace vat
