#pragma once

#include <string>

namespace vat::script {

/// Where a WebSocket server listens.
struct WebSocketUrl {
  std::string host;  ///< a name or a numeric address, IPv6 without brackets
  std::string port = "80";
  std::string path = "/ws";

  /// As in an HTTP request's Host.
  std::string authority() const;
};

/// Reads "ws://HOST[:PORT][/PATH]". Throws std::invalid_argument, which tells what is wrong.
WebSocketUrl read_websocket_url(const std::string& text);

}  // namespace vat::script
