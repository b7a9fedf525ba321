#pragma once

#include <array>
#include <stdexcept>
#include <string>

#include "core/support/names.h"

namespace vat {

/// Failed operation of NATS.
class NatsError : public std::runtime_error {
 public:
  enum class Kind {
    conflict,      ///< another client has changed the subject or key since it was read
    unreachable,   ///< no answer; the operation may have been executed
    disconnected,  ///< there is no connection; the operation was not executed
    refused        ///< the server has refused the operation
  };

  NatsError(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};
template <>
inline constexpr std::array kNamesOf<NatsError::Kind>{"conflict", "unreachable", "disconnected",
                                                      "refused"};

}  // namespace vat
