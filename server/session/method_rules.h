#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "server/session/role.h"

namespace vat {

/// What a message is counted as where messages are counted.
enum class MessageClass : std::uint8_t {
  query,    ///< asks, or says what is seen
  control,  ///< a command of a few numbers
  pointer,  ///< follows a pointer; the newest counts
  scene     ///< carries a scene or a body, and may be long
};
const char* to_string(MessageClass message_class);

/// What holds for a method whatever its parameters are: who may call it, what it counts as, and
/// whether it changes what a session is, so that it belongs in the session's log.
struct MethodRules {
  std::string_view method;
  Role least_role;
  MessageClass message_class;
  bool is_logged;
};

/// One row for every method of PROTOCOL.md, in its order.
std::span<const MethodRules> method_rules();

}  // namespace vat
