#pragma once

#include <boost/asio/ssl/context.hpp>
#include <boost/system/error_code.hpp>
#include <string>

#include "server/script/websocket_url.h"

namespace vat::script {

/// Returns a client context for TLS 1.2 and later. Throws std::runtime_error if the file cannot be
/// used.
boost::asio::ssl::context make_client_context(const TlsTrust& trust);

/// Requests the server at `url` in the handshake of `tls`, and accepts only its certificate.
void expect_server(SSL* tls, const WebSocketUrl& url);

/// Returns the reason of a failed handshake, and a hint.
std::string handshake_fault(SSL* tls, const WebSocketUrl& url,
                            const boost::system::error_code& failure);

}  // namespace vat::script
