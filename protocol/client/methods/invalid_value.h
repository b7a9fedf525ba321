#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace vat::client {

/// Exception: a message of the server does not conform to the protocol.
class InvalidValue : public std::runtime_error {
 public:
  /// `path` is the JSON pointer of the value.
  explicit InvalidValue(const std::string& fault, std::string path = {})
      : std::runtime_error((path.empty() ? "the value" : path) + ' ' + fault),
        fault_(fault),
        path_(std::move(path)) {}

  /// Returns the error of a value that contains the invalid value as its member or element `key`.
  InvalidValue inside(const std::string& key) const {
    return InvalidValue(fault_, '/' + key + path_);
  }

 private:
  std::string fault_;
  std::string path_;
};

}  // namespace vat::client
