#pragma once

#include <cstdint>

namespace vat {

/// What a client may do in a session; each role may do what those before it may.
enum class Role : std::uint8_t {
  none,        ///< in no session
  viewer,      ///< watches and asks
  controller,  ///< changes what is simulated
  owner        ///< decides who may, and ends the session
};
const char* to_string(Role role);

}  // namespace vat
