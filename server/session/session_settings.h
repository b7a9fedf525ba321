#pragma once

#include <string>

#include "server/access/role.h"
#include "server/net/transport.h"

namespace vat {

/// What an owner decides of a session.
struct SessionSettings {
  std::string name;
  Role default_role = Role::controller;  ///< of who joins without an invitation
  bool is_locked = false;                ///< nobody joins without an invitation
  ConnectionId creator = 0;              ///< owner as soon as it joins; 0: nobody
};

}  // namespace vat
