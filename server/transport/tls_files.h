#pragma once

#include <boost/asio/ssl/context.hpp>
#include <memory>
#include <mutex>
#include <string>

namespace vat {

/// TLS context from PEM files, which can be read again during operation. Thread-safe.
class TlsFiles {
 public:
  using Context = boost::asio::ssl::context;

  /// Reads the files. Throws like read().
  TlsFiles(std::string certificate_file, std::string key_file);

  /// Reads the files for later calls of context(). Throws std::runtime_error that names the invalid
  /// file and the reason. The previous context then remains in use.
  void read();
  std::shared_ptr<Context> context() const;

 private:
  const std::string certificate_file_;
  const std::string key_file_;
  mutable std::mutex mutex_;
  std::shared_ptr<Context> context_;
};

}  // namespace vat
