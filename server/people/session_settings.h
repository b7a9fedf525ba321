#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "server/access/role.h"
#include "server/people/governor_points.h"
#include "server/transport/transport.h"

namespace vat {

/// Permission to change the numerics of a session that is slower than requested.
struct GovernorPermission {
  std::uint64_t scene = 0;  ///< sequence of the log entry that loaded the scene of the points
  std::vector<GovernorPoint> points;  ///< empty: no permission
};

/// Settings that a session's owner can change.
struct SessionSettings {
  std::string name;
  Role default_role = Role::controller;  ///< role of participants without an invitation
  bool is_locked = false;                ///< joining requires an invitation
  ConnectionId creator = 0;  ///< connection that becomes the owner when it joins; 0: none
  GovernorPermission governor{};
};

}  // namespace vat
