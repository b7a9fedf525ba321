#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "server/access/role.h"
#include "server/session/rpc_message.h"

namespace vat {

/// What a message is counted as where messages are counted.
enum class MessageClass : std::uint8_t {
  query,    ///< asks, or says what is seen
  control,  ///< a command of a few numbers
  pointer,  ///< follows a pointer; the newest counts
  scene     ///< carries a scene or a body, and may be long
};
inline constexpr std::size_t kMessageClasses = 4;
const char* to_string(MessageClass message_class);

/// What holds for a method whatever its parameters are: who may call it, what it counts as, and
/// whether it changes what a session is, so that it belongs in the session's log.
///
/// The role that counts is, for a method of a session, that of the participant in it; for one of
/// the server, that which the client was let in with.
struct MethodRules {
  std::string_view method;
  Role least_role;
  MessageClass message_class;
  bool is_logged;
  bool is_of_named_session = false;  ///< what counts is the role in the session that it names
};

/// One row for every method of PROTOCOL.md, in its order.
std::span<const MethodRules> method_rules();
/// The row of this method; throws std::logic_error where there is none.
const MethodRules& rules_of(std::string_view method);
/// Whether it says when ticks are run and nothing else: those who play a log again decide that by
/// themselves.
bool is_of_clock(std::string_view method);
/// Why somebody with this role may not call the method, if so: the one place where roles are
/// checked.
std::optional<RpcError> refuse_role(const MethodRules& rules, Role role);

}  // namespace vat
