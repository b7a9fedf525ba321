#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/support/check.h"

namespace vat {

/// Error of an input. `path` is a JSON pointer such as "/bodies/3/radius", or empty for the whole
/// input. `message` states the permitted range of the field.
struct Error {
  std::string code;
  std::string path;
  std::string message;
  std::string suggestion = {};  ///< valid name near to the given one, or empty
};
using Errors = std::vector<Error>;

/// Either a value or at least one Error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(Errors{std::move(error)}) {}
  Result(Errors errors) : content_(std::move(errors)) {
    VAT_CHECK(!std::get<Errors>(content_).empty());
  }

  bool ok() const { return std::holds_alternative<T>(content_); }
  explicit operator bool() const { return ok(); }

  T& value() & { return checked(); }
  const T& value() const& {
    VAT_CHECK(ok());
    return std::get<T>(content_);
  }
  T&& value() && { return std::move(checked()); }
  const Errors& errors() const {
    VAT_CHECK(!ok());
    return std::get<Errors>(content_);
  }

 private:
  T& checked() {
    VAT_CHECK(ok());
    return std::get<T>(content_);
  }
  std::variant<T, Errors> content_;
};

/// Success, or at least one Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : errors_{std::move(error)} {}
  Result(Errors errors) : errors_(std::move(errors)) {}

  bool ok() const { return errors_.empty(); }
  explicit operator bool() const { return ok(); }
  const Errors& errors() const { return errors_; }

 private:
  Errors errors_;
};
using Status = Result<void>;

}  // namespace vat
