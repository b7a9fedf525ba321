#pragma once

#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <string>

namespace vat {

/// TLS 1.2 and above, with the certificate (and those above it) and the private key of two files in
/// PEM. Throws std::runtime_error that names the file which cannot be used, and why.
std::shared_ptr<boost::asio::ssl::context> make_tls_context(const std::string& certificate_file,
                                                            const std::string& key_file);

}  // namespace vat
