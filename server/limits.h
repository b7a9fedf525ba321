#pragma once

#include <cstddef>
#include <cstdint>

#include "core/limits.h"

/// Every cap on what clients can make the server grow or do, with the reason. `server.info` tells
/// them by the names of this file without the leading "max_"; core/limits.h caps single scenes.
namespace vat {

struct ServerLimits {
  std::size_t max_connections = 256;         ///< WebSockets; threads and memory are shared by all
  std::size_t max_sessions = 16;             ///< each holds a simulation and steps it all the time
  std::size_t max_clients_per_session = 64;  ///< each frame is copied and sent once a client
  std::size_t max_particles = 200'000;       ///< of one session; 1 kB and 6 bytes a frame each
  /// Particles times steps of one tick: a tick cannot be interrupted, and others wait for its
  /// thread (about a second at the limit).
  std::size_t max_particle_steps_per_tick = 4'000'000;
  std::size_t max_message_bytes = 64 * 1024;              ///< of messages without a scene or body
  std::size_t max_scene_message_bytes = 4 * 1024 * 1024;  ///< of messages with one
  std::size_t max_message_values = 100'000;               ///< parsing holds up the network's thread
  std::size_t max_message_depth = 16;                     ///< JSON levels; a scene needs 8
  std::size_t max_commands_in_flight = 256;     ///< of one client: sent to a session, unanswered
  std::size_t max_grabs_per_client = 10;        ///< one a finger; core/limits.h caps a session's
  std::size_t max_name_bytes = kMaxNameLength;  ///< session names are shown to other users
  std::uint64_t max_ticks_per_step = 1000;      ///< of one control.step: it must end
  std::size_t max_bodies_per_query = kMaxBodies;
};

/// Frames sent and not acknowledged; PROTOCOL.md fixes it.
inline constexpr std::uint32_t kFrameWindow = 3;

/// Control messages that may wait for one client; PROTOCOL.md fixes it.
inline constexpr std::size_t kMaxControlQueueBytes = 1024 * 1024;

}  // namespace vat
