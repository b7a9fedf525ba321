#pragma once

#include <string>

namespace vat::script {

/// Address of a WebSocket server.
struct WebSocketUrl {
  std::string host;  ///< a name or a numeric address, IPv6 without brackets
  std::string port = "80";
  std::string path = "/ws";
  bool is_secure = false;  ///< uses TLS

  /// As in the header Host of an HTTP request.
  std::string authority() const;
};

/// Certificates that a client accepts.
struct TlsTrust {
  std::string authority_file;  ///< PEM file that replaces the system's; "": the system's
  bool is_unchecked = false;   ///< accepts any certificate
};

/// Reads "ws://HOST[:PORT][/PATH]", or wss:// with TLS and the default port 443. Throws
/// std::invalid_argument with the reason.
WebSocketUrl read_websocket_url(const std::string& text);

}  // namespace vat::script
