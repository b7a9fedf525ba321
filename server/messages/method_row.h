#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "server/access/role.h"
#include "server/messages/rpc_message.h"

namespace vat {

/// Rate limit that applies to a message.
enum class RateClass : std::uint8_t {
  query,    ///< reads few data, or acknowledges a frame
  control,  ///< command with a few numbers
  pointer,  ///< command that follows a pointer; only the latest per tick is executed
  scene,    ///< command with a scene or a body, which may be long
  read      ///< reads the state of a session, which may be long
};
template <>
inline constexpr std::array kNamesOf<RateClass>{"query", "control", "pointer", "scene", "read"};

/// Whether calls of a method are logged. A recovery or a replay repeats logged calls.
enum class Logging : std::uint8_t {
  none,
  clock,  ///< logged; only controls when ticks run. A replay skips the call.
  scene   ///< logged; changes the simulation. Not allowed in a replay.
};

/// Role that must be at least the least role of a method.
enum class RoleSource : std::uint8_t {
  connection,   ///< role that access.enter granted to the connection
  participant,  ///< caller's role in the session that the caller has joined
  named         ///< caller's role in the session that the parameters name
};

/// Properties of a method that do not depend on its parameters. server/rpc/method_table.cpp
/// contains the table.
struct MethodRow {
  std::string_view name;
  Role least_role = Role::none;
  RoleSource role_source = RoleSource::connection;
  RateClass rate_class = RateClass::query;
  Logging logging = Logging::none;

  /// Returns the name of the file in protocol/schemas/ with the schemas NAME.params and
  /// NAME.result.
  std::string schema_file() const;
  constexpr bool is_logged() const { return logging != Logging::none; }
  constexpr bool changes_scene() const { return logging == Logging::scene; }
};

/// Returns an error if `role` is below the least role of the method. All role checks use this
/// function.
std::optional<RpcError> refuse_role(const MethodRow& row, Role role);

}  // namespace vat
