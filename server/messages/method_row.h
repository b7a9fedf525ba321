#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/access/role.h"
#include "server/messages/rpc_message.h"

namespace vat {

/// The rate limit that a message counts towards.
enum class RateClass : std::uint8_t {
  query,    ///< reads, or acknowledges a frame
  control,  ///< a command with a few numbers
  pointer,  ///< follows a pointer; only the latest of one tick is executed
  scene     ///< contains a scene or a body, and may be long
};
template <>
inline constexpr std::array kNamesOf<RateClass>{"query", "control", "pointer", "scene"};

/// Whether the calls of a method are logged, so that a recovery or replay repeats them.
enum class Logging : std::uint8_t {
  none,
  clock,  ///< logged; sets only when ticks run. A replay has its own clock and skips it.
  scene   ///< logged; changes the simulation. Not allowed in a replay.
};

/// The role that is compared with the least role of a method.
enum class RoleSource : std::uint8_t {
  connection,   ///< granted to the connection by access.enter
  participant,  ///< of the caller in the session that it has joined
  named         ///< of the caller in the session that the parameters name
};

/// Properties of a method that do not depend on its parameters. The table is in
/// server/rpc/method_table.cpp.
struct MethodRow {
  std::string_view name;
  Role least_role = Role::none;
  RoleSource role_source = RoleSource::connection;
  RateClass rate_class = RateClass::query;
  Logging logging = Logging::none;

  /// File in protocol/schemas/ that defines the schemas NAME.params and NAME.result.
  std::string schema_file() const;
  constexpr bool is_logged() const { return logging != Logging::none; }
  constexpr bool changes_scene() const { return logging == Logging::scene; }
};

/// Returns the error if `role` is below the least role of the method. The only check of roles.
std::optional<RpcError> refuse_role(const MethodRow& row, Role role);

}  // namespace vat
