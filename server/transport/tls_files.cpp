#include "server/transport/tls_files.h"

#include <openssl/ssl.h>

#include <stdexcept>
#include <utility>

namespace vat {

namespace {

void expect(const boost::system::error_code& error, const std::string& file, const char* what) {
  if (error) {
    throw std::runtime_error(file + ": cannot be read as " + what + " in PEM: " + error.message());
  }
}

/// Returns a context for TLS 1.2 and later with the certificate chain and private key.
std::shared_ptr<TlsFiles::Context> make_context(const std::string& certificate_file,
                                                const std::string& key_file) {
  auto context = std::make_shared<TlsFiles::Context>(TlsFiles::Context::tls_server);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  // Otherwise a client could make the server compute keys without limit.
  SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
  boost::system::error_code error;
  context->use_certificate_chain_file(certificate_file, error);
  expect(error, certificate_file, "a certificate");
  context->use_private_key_file(key_file, TlsFiles::Context::pem, error);
  expect(error, key_file, "the key of that certificate");
  return context;
}

}  // namespace

TlsFiles::TlsFiles(std::string certificate_file, std::string key_file)
    : certificate_file_(std::move(certificate_file)), key_file_(std::move(key_file)) {
  read();
}

void TlsFiles::read() {
  std::shared_ptr<Context> context = make_context(certificate_file_, key_file_);
  const std::lock_guard lock(mutex_);
  context_ = std::move(context);
}

std::shared_ptr<TlsFiles::Context> TlsFiles::context() const {
  const std::lock_guard lock(mutex_);
  return context_;
}

}  // namespace vat
