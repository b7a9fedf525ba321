#pragma once

#include <cstdint>

namespace vat {

/// What a client may do; each role may do what those before it may.
enum class Role : std::uint8_t {
  none,        ///< has not been let in
  viewer,      ///< watches and asks
  controller,  ///< changes what is simulated
  owner,       ///< of a session: decides who may, and ends it
  admin        ///< of the server: all, in every session
};
const char* to_string(Role role);

}  // namespace vat
