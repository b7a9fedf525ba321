#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "server/transport/address_counts.h"
#include "server/transport/client_address.h"
#include "server/transport/tls_files.h"
#include "server/transport/transport.h"
#include "server/transport/ws_server.h"
#include "server/transport/ws_task_queue.h"
#include "server/transport/ws_upgrade.h"

namespace vat {

/// State that the endpoints of a transport share. Limits apply to all endpoints together.
struct WsShared {
  WsShared(TransportSettings settings_in, ConnectionHandler& connections_in, HttpHandler http_in)
      : settings(std::move(settings_in)),
        proxies(settings.trusted_proxies),
        connections(connections_in),
        http(std::move(http_in)) {}

  const TransportSettings settings;
  const TrustedProxies proxies;
  std::shared_ptr<TlsFiles> tls;  ///< null: no TLS
  ConnectionHandler& connections;
  const HttpHandler http;
  std::atomic<ConnectionId> last_id = 0;
  std::atomic<std::size_t> open_count = 0;  ///< number of open WebSockets
  AddressCounts open_by_address;
  AddressCounts sockets_by_address;
  /// Number of all sockets. Shared with the streams, which may outlive the transport.
  const std::shared_ptr<std::atomic<std::size_t>> socket_count =
      std::make_shared<std::atomic<std::size_t>>(0);
};

/// Endpoint of websocketpp with its thread. Only this thread calls the library for the endpoint.
class WsEndpoint {
 public:
  explicit WsEndpoint(WsShared& shared);
  /// The thread must have been joined.
  ~WsEndpoint();
  WsEndpoint(const WsEndpoint&) = delete;
  WsEndpoint& operator=(const WsEndpoint&) = delete;

  /// Throws like listen() if another program listens on the port. listen() with `shares_port` does
  /// not detect another program.
  void check_free(std::uint16_t port);
  /// Listens on the port (0: any free port). If `shares_port`, other endpoints can listen on the
  /// same port. Returns the port. Throws std::runtime_error on failure, with a message that names
  /// host and port.
  std::uint16_t listen(std::uint16_t port, bool shares_port);
  /// Starts the thread.
  void start();
  /// Starts the shutdown for Transport::stop(). join() waits for the end of the shutdown.
  void begin_stop();
  void join();

 private:
  using Handle = websocketpp::connection_hdl;
  using StreamPtr = std::shared_ptr<WsStream>;

  /// Sockets besides the WebSockets: HTTP requests, pending upgrades, refused and ending
  /// connections.
  static constexpr std::size_t kMaxOtherSockets = 256;
  static constexpr std::size_t kMaxOtherSocketsPerAddress = 64;

  void configure();
  void set_handlers();
  void run();
  void forget_all();

  void accepted(WsStream& stream);
  bool count_socket(WsStream& stream);
  void count_refusal(std::string_view limit) const;
  void opened(const StreamPtr& stream);
  void received(WsStream& stream, const WsMessage& message);
  void answer_ping(WsStream& stream, const std::string& payload);
  void closed(WsStream& stream);

  // In ws_endpoint_http.cpp.
  std::optional<HttpRefusal> refuse_request(WsStream& stream);
  bool validate(WsStream& stream);
  void answer_http(const StreamPtr& stream);
  void answer_later(const StreamPtr& stream, const HttpResponse& response);
  void send_response(const StreamPtr& stream, const HttpResponse& response);
  void add_strict_transport(WsStream& stream) const;
  bool may_keep(const WsStream& stream) const;
  void continue_with_next(WsStream& answered);
  HttpResponse ask_http_handler(const WsStream& stream);

  void start_pings();
  void ping_all();
  void close_all();
  std::vector<StreamPtr> open_streams() const;

  StreamPtr stream_of(const Handle& handle);
  template <class Work>
  bool guarded(const char* place, Work&& work) noexcept;
  void report(const char* place, const char* fault) noexcept;

  WsShared& shared_;
  boost::asio::io_context io_{1};
  /// Shared with the connections, which may outlive the endpoint.
  std::shared_ptr<WsTaskQueue> tasks_;
  WsServer server_;
  boost::asio::steady_timer ping_timer_;
  boost::asio::steady_timer stop_timer_;
  std::thread thread_;

  // Members that only the endpoint's thread uses while it runs.
  std::unordered_map<ConnectionId, std::weak_ptr<WsStream>> open_;
  /// Requests whose responses follow. The library keeps no reference to a stream without work.
  std::unordered_set<StreamPtr> awaiting_response_;
  bool stopping_ = false;
};

template <class Work>
bool WsEndpoint::guarded(const char* place, Work&& work) noexcept {
  try {
    work();
    return true;
  } catch (const std::exception& fault) {
    report(place, fault.what());
  } catch (...) {
    report(place, "unknown exception");
  }
  return false;
}

}  // namespace vat
