#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "server/net/transport.h"
#include "server/net/ws_endpoint.h"

namespace vat {

/// The transport on websocketpp. The library is no match for several threads in one endpoint; so
/// each thread has an endpoint of its own, and they listen on one port.
class WsTransport final : public Transport {
 public:
  WsTransport(TransportSettings settings, ConnectionHandler& connections, HttpHandler http);
  ~WsTransport() override;

  std::uint16_t start() override;
  void stop() override;

 private:
  std::uint16_t listen();

  WsShared shared_;
  std::vector<std::unique_ptr<WsEndpoint>> endpoints_;
  bool running_ = false;
};

}  // namespace vat
