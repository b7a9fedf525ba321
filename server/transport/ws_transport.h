#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "server/transport/transport.h"
#include "server/transport/ws_endpoint.h"

namespace vat {

/// Transport with websocketpp. The library has races if several threads run one endpoint. Each
/// thread therefore has its own endpoint, and all listen on one port.
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
