#pragma once

#include <string>

namespace vat::script {

/// Where a WebSocket server listens.
struct WebSocketUrl {
  std::string host;  ///< a name or a numeric address, IPv6 without brackets
  std::string port = "80";
  std::string path = "/ws";
  bool is_secure = false;  ///< over TLS

  /// As in an HTTP request's Host.
  std::string authority() const;
};

/// Whose certificates are believed.
struct TlsTrust {
  std::string authority_file;  ///< in PEM, in place of the system's; "": the system's
  bool is_unchecked = false;   ///< whoever answers is believed
};

/// Reads "ws://HOST[:PORT][/PATH]", or wss:// over TLS, by default at port 443. Throws
/// std::invalid_argument, which tells what is wrong.
WebSocketUrl read_websocket_url(const std::string& text);

}  // namespace vat::script
