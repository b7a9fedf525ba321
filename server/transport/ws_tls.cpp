#include "server/transport/ws_tls.h"

#include <openssl/ssl.h>

#include <stdexcept>

namespace vat {

namespace {

namespace ssl = boost::asio::ssl;

void expect(const boost::system::error_code& error, const std::string& file, const char* what) {
  if (error) {
    throw std::runtime_error(file + ": cannot be read as " + what + " in PEM: " + error.message());
  }
}

}  // namespace

std::shared_ptr<ssl::context> make_tls_context(const std::string& certificate_file,
                                               const std::string& key_file) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  // A client could make the server compute keys without end.
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  boost::system::error_code error;
  context->use_certificate_chain_file(certificate_file, error);
  expect(error, certificate_file, "a certificate");
  context->use_private_key_file(key_file, ssl::context::pem, error);
  expect(error, key_file, "the key of that certificate");
  return context;
}

}  // namespace vat
