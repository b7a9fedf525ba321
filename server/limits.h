#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

/// Every cap on what clients can make the server grow or do, with the reason. core/limits.h has
/// those of single scenes.
namespace vat {

struct ServerLimits {
  std::size_t max_connections = 1024;             ///< WebSockets; a file descriptor each
  std::size_t max_connections_per_address = 256;  ///< so that one host does not take all
  std::size_t max_sessions = 16;                  ///< each holds a simulation and steps it
  std::size_t max_sessions_per_address = 8;       ///< that clients of an address have created
  std::size_t max_replays = 4;  ///< sessions that show recordings, of up to 384 MiB each
  std::size_t max_clients_per_session = 1024;    ///< each frame is sent once a client
  std::size_t max_particles = 200'000;           ///< of one session; memory: up to 2 kB each
  std::size_t max_springs = 2'000'000;           ///< of one session; 13 per particle of a lattice
  std::size_t max_particles_in_all = 1'000'000;  ///< of all sessions
  std::size_t max_springs_in_all = 8'000'000;    ///< the same
  /// Particles times steps of one tick: a tick is not interrupted, and commands wait for it. About
  /// a second at the limit.
  std::size_t max_particle_steps_per_tick = 4'000'000;
  std::size_t max_message_bytes = 64 * 1024;  ///< of messages that hold neither scene nor body
  std::size_t max_scene_message_bytes = 4 * 1024 * 1024;  ///< of messages that do
  std::size_t max_message_depth = 16;                     ///< lists and objects within each other
  std::size_t max_message_values = 100'000;               ///< memory: a tenth of a kB each
  std::size_t max_commands_in_flight = 256;               ///< of one client: not answered yet
  std::size_t max_bytes_in_flight = 8'000'000;            ///< of these commands' messages
  /// Of replies and events that a client has not taken; then it is closed.
  std::size_t max_control_queue_bytes = 1024 * 1024;
  std::size_t max_grabs_per_client = 10;  ///< one a finger
  // Messages a second of one connection, by what they count as: several times what a viewer sends.
  double max_queries_per_second = 500;  ///< acknowledgements included, one a frame
  double max_controls_per_second = 200;
  double max_pointer_moves_per_second = 250;
  double max_scenes_per_second = 5;                 ///< each may be long, and is checked as a whole
  double max_message_bytes_per_second = 8'000'000;  ///< reading them takes a fifth of a core
  double burst_seconds = 4;                         ///< so much of these may come at once
  /// Refused messages a second, and at once as above, after which a connection is closed.
  double max_refusals_per_second = 100;
  /// For the acknowledgement of a frame: a viewer that has stopped reading holds memory.
  std::chrono::seconds frame_patience{30};
  /// In which a participant whose connection has ended can be resumed by another one.
  std::chrono::milliseconds resume_time{30'000};
  /// Without a move, after which a grab ends: the body is somebody else's to hold.
  std::chrono::milliseconds grab_idle{30'000};
  std::size_t max_recording_bytes = std::size_t{256} << 20;  ///< of one; it is made in memory
  std::size_t max_download_bytes = std::size_t{512} << 20;   ///< of all that wait to be fetched
  /// For a whole HTTP request, or the upgrade to a WebSocket.
  std::chrono::milliseconds handshake_time{10'000};
  /// A peer that is silent for two of them is dropped.
  std::chrono::milliseconds ping_interval{20'000};
  std::size_t max_tokens = 10'000;  ///< invitations and tickets that are good at once
  // What users save.
  std::size_t max_states_per_session = 20;
  std::size_t max_state_bytes_per_session = std::size_t{64} << 20;
  std::size_t max_state_bytes_in_all = std::size_t{512} << 20;
  std::size_t max_scenes_per_address = 50;
  std::size_t max_scene_bytes_per_address = std::size_t{32} << 20;
  std::size_t max_scenes_in_all = 1000;
  std::size_t max_scene_bytes_in_all = std::size_t{256} << 20;
  /// A session without participants stands still after so long; 0: never.
  std::chrono::milliseconds hibernate_after{60'000};
  /// And ends after so long, unless it is the first; 0: never.
  std::chrono::milliseconds expire_after{24 * 3'600'000};
  /// A replay ends after so long, or as any session if that is sooner.
  std::chrono::milliseconds replay_expire_after{300'000};
};

/// Of max_message_depth: what was logged under another setting is still read.
inline constexpr std::size_t kMaxMessageDepth = 64;

/// Fixed by PROTOCOL.md.
inline constexpr std::size_t kMaxTicksPerStep = 1000;
inline constexpr std::size_t kMaxFrameInterval = 100;  // [ticks]
inline constexpr double kMinSpeedFactor = 0.05;        // simulated seconds per second
inline constexpr double kMaxSpeedFactor = 4;           // the same
inline constexpr std::uint32_t kFrameWindow = 3;       // frames sent and not acknowledged
inline constexpr std::size_t kMaxFrameGroups = 8;      // frames that are made of one state
inline constexpr std::uint64_t kMaxExactCount = 9'007'199'254'740'992;  // 2^53: JSON's numbers
inline constexpr std::size_t kMaxConnections = 10'000;  // of springs, and of contacts, in a reply
inline constexpr std::size_t kDefaultConnections = 2000;
inline constexpr std::size_t kMaxPresence = 100;    // participants that others are told of
inline constexpr std::size_t kMaxTokenBytes = 256;  // of what a client shows to be let in
inline constexpr std::size_t kMaxImportPart = 4 * 1024 * 1024;  // of one message's base64
inline constexpr std::uint64_t kMaxRecordedTicks = 10'000'000;  // of an import; two days at 50 Hz
inline constexpr std::size_t kMaxRecordedEntries = 1'000'000;   // the same
inline constexpr std::size_t kMaxLongMessages = 2;  // longer than that, in the control queue

}  // namespace vat
