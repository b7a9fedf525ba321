#pragma once

#include <cstdint>

#include "core/support/names.h"

namespace vat {

/// Role of a client. Each role includes the rights of all previous roles.
enum class Role : std::uint8_t {
  none,        ///< no token was sent yet
  viewer,      ///< may watch and read
  controller,  ///< may change the simulation
  owner,       ///< may set roles and close the session
  admin        ///< has all rights in all sessions of the server
};
template <>
inline constexpr std::array kNamesOf<Role>{"none", "viewer", "controller", "owner", "admin"};

}  // namespace vat
