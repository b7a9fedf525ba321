#pragma once

#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <string>

namespace vat {

/// Returns a context for TLS 1.2 and later with the certificate chain and private key of two PEM
/// files. Throws std::runtime_error that names the invalid file and the reason.
std::shared_ptr<boost::asio::ssl::context> make_tls_context(const std::string& certificate_file,
                                                            const std::string& key_file);

}  // namespace vat
