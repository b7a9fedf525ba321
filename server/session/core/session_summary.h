#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/people/participants.h"

namespace vat {

/// A participant as `server.sessions` lists it.
struct PersonSummary {
  ParticipantNumber number = 0;
  std::string name;
  Role role = Role::viewer;
  std::string address;  ///< empty: disconnected
};

/// A session as `session.list` lists it.
struct SessionSummary {
  std::string name;
  std::string scene;
  std::size_t clients = 0;
  bool playing = false;
  std::uint64_t tick = 0;
  std::size_t particles = 0;
  ConnectionId creator = 0;  ///< becomes the owner when it joins; 0: none
  bool is_replay = false;
  bool hibernating = false;                            ///< plays, but has no participants
  std::optional<SteadyClock::time_point> empty_since;  ///< set while there are no participants
  std::shared_ptr<const std::vector<PersonSummary>> people;  ///< null: unknown
};

}  // namespace vat
