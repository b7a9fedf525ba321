#pragma once

#include <cstdint>

#include "core/support/names.h"

namespace vat {

/// Role of a client. Each role includes the rights of those before it.
enum class Role : std::uint8_t {
  none,        ///< no token was sent yet
  viewer,      ///< watches and reads
  controller,  ///< changes the simulation
  owner,       ///< of a session: sets roles, and closes it
  admin        ///< of the server: all rights in all sessions
};
template <>
inline constexpr std::array kNamesOf<Role>{"none", "viewer", "controller", "owner", "admin"};

}  // namespace vat
