#pragma once

#include <string>

#include "server/access/role.h"
#include "server/transport/transport.h"

namespace vat {

/// Settings that a session's owner can change.
struct SessionSettings {
  std::string name;
  Role default_role = Role::controller;  ///< role of participants without an invitation
  bool is_locked = false;                ///< joining requires an invitation
  ConnectionId creator = 0;  ///< connection that becomes the owner when it joins; 0: none
};

}  // namespace vat
