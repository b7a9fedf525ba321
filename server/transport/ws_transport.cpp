#include "server/transport/ws_transport.h"

#include <openssl/ssl.h>

#include <algorithm>
#include <boost/asio/ssl/context.hpp>
#include <stdexcept>
#include <utility>

namespace vat {
namespace {

namespace ssl = boost::asio::ssl;

void expect(const boost::system::error_code& error, const std::string& file, const char* what) {
  if (error) {
    throw std::runtime_error(file + ": cannot be read as " + what + " in PEM: " + error.message());
  }
}

/// Returns a context for TLS 1.2 and later with the certificate chain and private key of two PEM
/// files. Throws std::runtime_error that names the invalid file and the reason.
std::shared_ptr<ssl::context> make_tls_context(const std::string& certificate_file,
                                               const std::string& key_file) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  // Otherwise a client could make the server compute keys without limit.
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  boost::system::error_code error;
  context->use_certificate_chain_file(certificate_file, error);
  expect(error, certificate_file, "a certificate");
  context->use_private_key_file(key_file, ssl::context::pem, error);
  expect(error, key_file, "the key of that certificate");
  return context;
}

}  // namespace

WsTransport::WsTransport(TransportSettings settings, ConnectionHandler& connections,
                         HttpHandler http)
    : shared_(std::move(settings), connections, std::move(http)) {
  if (!shared_.settings.tls_certificate.empty()) {
    shared_.tls = make_tls_context(shared_.settings.tls_certificate, shared_.settings.tls_key);
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

std::unique_ptr<Transport> make_websocket_transport(TransportSettings settings,
                                                    ConnectionHandler& connections,
                                                    HttpHandler http) {
  return std::make_unique<WsTransport>(std::move(settings), connections, std::move(http));
}

}  // namespace vat
