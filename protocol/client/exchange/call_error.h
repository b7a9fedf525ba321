#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace vat::client {

/// Exception: a call has no result. The member what() is a text for people.
class CallError : public std::runtime_error {
 public:
  CallError(std::string kind, const std::string& message, int code = 0, nlohmann::json data = {})
      : std::runtime_error(message), kind_(std::move(kind)), code_(code), data_(std::move(data)) {}

  /// Returns `data.kind` of the server's error (protocol/PROTOCOL.md, "Errors"), or one of these
  /// kinds with the code 0:
  /// - `disconnected`: there is no connection, or it ended before the reply. The server may have
  ///   executed the call.
  /// - `timed_out`: no reply arrived within Options::call_timeout.
  /// - `too_many_calls`: too many calls wait for their replies or for the network.
  /// - `invalid_reply`: the reply does not conform to the protocol.
  const std::string& kind() const { return kind_; }
  int code() const { return code_; }
  /// Returns the JSON pointer to the invalid parameter, or "".
  std::string path() const { return text("path"); }
  /// Returns the action that resolves the error, or "".
  std::string hint() const { return text("hint"); }
  /// Returns all data of the server's error, for example `limit` and `maximum`.
  const nlohmann::json& data() const { return data_; }

 private:
  std::string text(const char* key) const {
    const auto found = data_.find(key);
    return found != data_.end() && found->is_string() ? found->get<std::string>() : "";
  }

  std::string kind_;
  int code_ = 0;
  nlohmann::json data_;
};

/// Either the result of a call or its error.
template <class Value>
class [[nodiscard]] Outcome {
 public:
  Outcome(Value value) : content_(std::move(value)) {}
  Outcome(CallError error) : content_(std::move(error)) {}

  bool ok() const { return std::holds_alternative<Value>(content_); }
  explicit operator bool() const { return ok(); }
  /// Returns the result. Throws the CallError of a failed call.
  Value& value() {
    throw_error();
    return std::get<Value>(content_);
  }
  const Value& value() const {
    throw_error();
    return std::get<Value>(content_);
  }
  /// Returns the error of a failed call. Throws std::bad_variant_access if the call succeeded.
  const CallError& error() const { return std::get<CallError>(content_); }

 private:
  void throw_error() const {
    if (!ok()) throw CallError(error());
  }

  std::variant<Value, CallError> content_;
};

}  // namespace vat::client
