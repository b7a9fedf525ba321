#include "server/transport/ws_transport.h"

#include <algorithm>
#include <utility>

namespace vat {

WsTransport::WsTransport(TransportSettings settings, ConnectionHandler& connections,
                         HttpHandler http)
    : shared_(std::move(settings), connections, std::move(http)) {
  if (!shared_.settings.tls_certificate.empty()) {
    shared_.tls =
        std::make_shared<TlsFiles>(shared_.settings.tls_certificate, shared_.settings.tls_key);
  }
  const std::size_t count = std::max<std::size_t>(1, shared_.settings.endpoints);
  while (endpoints_.size() < count) endpoints_.push_back(std::make_unique<WsEndpoint>(shared_));
}

WsTransport::~WsTransport() {
  stop();
}

std::uint16_t WsTransport::start() {
  const std::uint16_t port = listen();
  for (const auto& endpoint : endpoints_) endpoint->start();
  running_ = true;
  return port;
}

std::uint16_t WsTransport::listen() {
  const bool share_port = endpoints_.size() > 1;
  std::uint16_t port = shared_.settings.port;
  if (share_port) endpoints_.front()->check_free(port);
  for (const auto& endpoint : endpoints_) port = endpoint->listen(port, share_port);
  return port;
}

void WsTransport::stop() {
  if (!std::exchange(running_, false)) return;
  for (const auto& endpoint : endpoints_) endpoint->begin_stop();
  for (const auto& endpoint : endpoints_) endpoint->join();
}

void WsTransport::read_certificate() {
  if (shared_.tls) shared_.tls->read();
}

std::unique_ptr<Transport> make_websocket_transport(TransportSettings settings,
                                                    ConnectionHandler& connections,
                                                    HttpHandler http) {
  return std::make_unique<WsTransport>(std::move(settings), connections, std::move(http));
}

}  // namespace vat
