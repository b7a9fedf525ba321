#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "server/transport/transport.h"
#include "server/transport/ws_endpoint.h"

namespace vat {

/// Transport that uses websocketpp. The library has data races if several threads run one endpoint.
/// Each thread therefore has a separate endpoint, and all endpoints listen on one port.
class WsTransport final : public Transport {
 public:
  WsTransport(TransportSettings settings, ConnectionHandler& connections, HttpHandler http);
  ~WsTransport() override;

  std::uint16_t start() override;
  void stop() override;
  void read_certificate() override;

 private:
  std::uint16_t listen();

  WsShared shared_;
  std::vector<std::unique_ptr<WsEndpoint>> endpoints_;
  bool running_ = false;
};

}  // namespace vat
