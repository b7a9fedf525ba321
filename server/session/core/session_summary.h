#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/people/participants.h"

namespace vat {

/// Participant in the result of `server.sessions`.
struct PersonSummary {
  ParticipantNumber number = 0;
  std::string name;
  Role role = Role::viewer;
  std::string address;  ///< empty: disconnected
};

/// Session in the result of `session.list`.
struct SessionSummary {
  std::string name;
  std::string scene;
  std::size_t clients = 0;
  bool playing = false;
  std::uint64_t tick = 0;
  std::size_t particles = 0;
  ConnectionId creator = 0;  ///< connection that becomes the owner when it joins; 0: none
  bool is_replay = false;
  bool hibernating = false;  ///< playing, but stopped without participants
  std::optional<SteadyClock::time_point> empty_since;  ///< start of the time without participants
  std::shared_ptr<const std::vector<PersonSummary>> people;  ///< null: unknown
  std::size_t replay_bytes = 0;                              ///< see Playback::cached_bytes()
};

}  // namespace vat
