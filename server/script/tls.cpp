#include "server/script/tls.h"

#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <boost/asio/ip/address.hpp>
#include <stdexcept>

namespace vat::script {

namespace ssl = boost::asio::ssl;
using boost::system::error_code;

ssl::context make_client_context(const TlsTrust& trust) {
  ssl::context context(ssl::context::tls_client);
  SSL_CTX_set_min_proto_version(context.native_handle(), TLS1_2_VERSION);
  context.set_verify_mode(trust.is_unchecked ? ssl::verify_none : ssl::verify_peer);
  error_code failure;
  if (trust.authority_file.empty()) {
    context.set_default_verify_paths(failure);
    if (failure) throw std::runtime_error("the system's certificates: " + failure.message());
  } else {
    context.load_verify_file(trust.authority_file, failure);
    if (failure) {
      throw std::runtime_error(trust.authority_file +
                               ": has no certificate in PEM that can be read");
    }
  }
  return context;
}

void expect_server(SSL* tls, const WebSocketUrl& url) {
  error_code no_address;
  boost::asio::ip::make_address(url.host, no_address);
  X509_VERIFY_PARAM* expected = SSL_get0_param(tls);
  if (no_address) {
    // SSL_set_tlsext_host_name() without its cast of the old kind.
    SSL_ctrl(tls, SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
             const_cast<char*>(url.host.c_str()));
    X509_VERIFY_PARAM_set1_host(expected, url.host.c_str(), url.host.size());
  } else {
    X509_VERIFY_PARAM_set1_ip_asc(expected, url.host.c_str());
  }
}

std::string handshake_fault(SSL* tls, const WebSocketUrl& url, const error_code& failure) {
  const long found = SSL_get_verify_result(tls);
  if (found != X509_V_OK && SSL_get_verify_mode(tls) != SSL_VERIFY_NONE) {
    return "the certificate of " + url.authority() +
           " is not trusted: " + X509_verify_cert_error_string(found) +
           "; --ca FILE names whom to trust, --insecure trusts whoever answers";
  }
  return "no TLS with " + url.authority() + ": " + failure.message() +
         "; a server without TLS is at ws://";
}

}  // namespace vat::script
