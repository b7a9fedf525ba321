#pragma once

#include <stdexcept>
#include <string>

namespace vat::client {

/// Address of a WebSocket server.
struct WebSocketUrl {
  std::string host;  ///< name or numeric address; IPv6 without brackets
  std::string port = "80";
  std::string path = "/ws";
  bool is_secure = false;  ///< uses TLS

  /// Returns the value of the HTTP header Host.
  std::string authority() const;
};

/// Certificates that a client accepts.
struct TlsTrust {
  /// PEM file that replaces the system's certificates. "": certificates of the system.
  std::string authority_file = {};
  bool is_unchecked = false;  ///< accepts all certificates
};

/// Exception: no trusted authority has signed the certificate of the server.
struct UntrustedServer : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Returns the parts of "ws://HOST[:PORT][/PATH]", or of a wss:// URL (TLS, default port 443).
/// Throws std::invalid_argument with the reason.
WebSocketUrl read_websocket_url(const std::string& text);

}  // namespace vat::client
