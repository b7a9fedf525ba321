#pragma once

#include <boost/asio/ssl/context.hpp>
#include <boost/system/error_code.hpp>
#include <string>

#include "server/script/websocket_url.h"

namespace vat::script {

/// A client's side of TLS 1.2 and above. Throws std::runtime_error where the file cannot be used.
boost::asio::ssl::context make_client_context(const TlsTrust& trust);

/// Has the handshake of `tls` ask for the server at `url`, and refuse another's certificate.
void expect_server(SSL* tls, const WebSocketUrl& url);

/// Why the handshake failed, and what to do.
std::string handshake_fault(SSL* tls, const WebSocketUrl& url,
                            const boost::system::error_code& failure);

}  // namespace vat::script
