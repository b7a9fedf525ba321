#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

/// Limits of all resources that clients can increase, with their reasons. core/limits.h has the
/// limits of single scenes.
namespace vat {

struct ServerLimits {
  std::size_t max_connections = 1024;             ///< WebSockets; each takes a file descriptor
  std::size_t max_connections_per_address = 256;  ///< leaves connections to other hosts
  std::size_t max_sessions = 16;                  ///< each stores and steps a simulation
  std::size_t max_sessions_per_address = 8;       ///< created by clients of one address
  std::size_t max_replays = 4;  ///< sessions that show recordings; memory: up to 384 MiB each
  std::size_t max_clients_per_session = 1024;    ///< each frame is sent once per client
  std::size_t max_particles = 200'000;           ///< of one session; memory: up to 2 kB each
  std::size_t max_springs = 2'000'000;           ///< of one session; a lattice has 13 per particle
  std::size_t max_particles_in_all = 1'000'000;  ///< of all sessions
  std::size_t max_springs_in_all = 8'000'000;    ///< of all sessions
  /// Particles times steps of one tick. A tick is not interrupted, and commands wait for it: about
  /// one second at the limit.
  std::size_t max_particle_steps_per_tick = 4'000'000;
  std::size_t max_message_bytes = 64 * 1024;              ///< of messages without scene or body
  std::size_t max_scene_message_bytes = 4 * 1024 * 1024;  ///< of messages with a scene or body
  std::size_t max_message_depth = 16;                     ///< nested lists and objects
  std::size_t max_message_values = 100'000;               ///< memory: about 100 bytes each
  std::size_t max_commands_in_flight = 256;               ///< unanswered commands of one client
  std::size_t max_bytes_in_flight = 8'000'000;            ///< bytes of their messages
  /// Replies and events that a client has not received. Beyond it, the connection is closed.
  std::size_t max_control_queue_bytes = 1024 * 1024;
  std::size_t max_grabs_per_client = 10;  ///< one per finger
  // Messages per second of one connection, by rate class: several times the rate of the viewer.
  double max_queries_per_second = 500;  ///< includes one acknowledgement per frame
  double max_controls_per_second = 200;
  double max_pointer_moves_per_second = 250;
  double max_scenes_per_second = 5;                 ///< each may be long, and is fully checked
  double max_message_bytes_per_second = 8'000'000;  ///< reading them takes a fifth of a core
  double burst_seconds = 4;                         ///< a burst may have the messages of this time
  /// Refused messages per second, with the same burst. Beyond it, the connection is closed.
  double max_refusals_per_second = 100;
  /// Time for the acknowledgement of a frame. A viewer that does not read occupies memory.
  std::chrono::seconds frame_patience{30};
  /// Time for which a disconnected participant can be resumed.
  std::chrono::milliseconds resume_time{30'000};
  /// Time without a move after which a grab ends, so that others can hold the body.
  std::chrono::milliseconds grab_idle{30'000};
  std::size_t max_recording_bytes = std::size_t{256}
                                    << 20;  ///< of one recording, which is made in memory
  std::size_t max_download_bytes = std::size_t{512}
                                   << 20;  ///< of all files that wait to be fetched
  /// Time for a whole HTTP request, or the upgrade to a WebSocket.
  std::chrono::milliseconds handshake_time{10'000};
  /// A peer that sends nothing for two intervals is disconnected.
  std::chrono::milliseconds ping_interval{20'000};
  std::size_t max_tokens = 10'000;  ///< valid invitations and tickets
  // Saved states and scenes.
  std::size_t max_states_per_session = 20;
  std::size_t max_state_bytes_per_session = std::size_t{64} << 20;
  std::size_t max_state_bytes_in_all = std::size_t{512} << 20;
  std::size_t max_scenes_per_address = 50;
  std::size_t max_scene_bytes_per_address = std::size_t{32} << 20;
  std::size_t max_scenes_in_all = 1000;
  std::size_t max_scene_bytes_in_all = std::size_t{256} << 20;
  /// Time without participants after which a session pauses; 0: never.
  std::chrono::milliseconds hibernate_after{60'000};
  /// Time without participants after which a session other than the first ends; 0: never.
  std::chrono::milliseconds expire_after{24 * 3'600'000};
  /// Shorter time of the same kind for replays.
  std::chrono::milliseconds replay_expire_after{300'000};
};

/// Greatest max_message_depth: entries that were logged with another setting remain readable.
inline constexpr std::size_t kMaxMessageDepth = 64;

/// Fixed by PROTOCOL.md.
inline constexpr std::size_t kMaxTicksPerStep = 1000;
inline constexpr std::size_t kMaxFrameInterval = 100;  // [ticks]
inline constexpr double kMinSpeedFactor = 0.05;        // simulated seconds per second
inline constexpr double kMaxSpeedFactor = 4;           // simulated seconds per second
inline constexpr std::uint32_t kFrameWindow = 3;       // frames sent and not acknowledged
inline constexpr std::size_t kMaxFrameGroups = 8;      // encoded frames per state
inline constexpr std::uint64_t kMaxExactCount =
    9'007'199'254'740'992;                              // 2^53: JSON numbers up to this are exact
inline constexpr std::size_t kMaxConnections = 10'000;  // springs, and contacts, in a reply
inline constexpr std::size_t kDefaultConnections = 2000;
inline constexpr std::size_t kMaxPresence = 100;    // participants that presence.list contains
inline constexpr std::size_t kMaxTokenBytes = 256;  // of a token in a request
inline constexpr std::size_t kMaxImportPart = 4 * 1024 * 1024;  // base64 of one message
inline constexpr std::uint64_t kMaxRecordedTicks = 10'000'000;  // of an import; two days at 50 Hz
inline constexpr std::size_t kMaxRecordedEntries = 1'000'000;   // of an import
inline constexpr std::size_t kMaxLongMessages =
    2;  // messages beyond the limit of the control queue

}  // namespace vat
