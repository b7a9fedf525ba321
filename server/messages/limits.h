#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>

/// Limits of all resources that clients can use, with reasons. core/limits.h defines the limits of
/// one scene.
namespace vat {

struct ServerLimits {
  std::size_t max_connections = 1024;             ///< WebSockets; each needs a file descriptor
  std::size_t max_connections_per_address = 256;  ///< reserves connections for other hosts
  std::size_t max_sessions = 16;                  ///< each stores and steps a simulation
  std::size_t max_sessions_per_address = 8;       ///< sessions created from one address
  std::size_t max_replays = 4;  ///< sessions that play recordings; up to 384 MiB each
  std::size_t max_clients_per_session = 1024;    ///< each frame is sent once per client
  std::size_t max_particles = 200'000;           ///< in one session; up to 2 kB of memory each
  std::size_t max_springs = 2'000'000;           ///< in one session; a lattice has 13 per particle
  std::size_t max_particles_in_all = 1'000'000;  ///< in all sessions
  std::size_t max_springs_in_all = 8'000'000;    ///< in all sessions
  /// Product of particles and steps of one tick. A tick cannot be interrupted, and commands wait
  /// for its end. A tick at the limit takes about one second.
  std::size_t max_particle_steps_per_tick = 4'000'000;
  std::size_t max_message_bytes = 64 * 1024;              ///< messages without scene or body
  std::size_t max_scene_message_bytes = 4 * 1024 * 1024;  ///< messages with a scene or body
  std::size_t max_message_depth = 16;                     ///< nesting of lists and objects
  std::size_t max_message_values = 100'000;               ///< memory: about 100 bytes per value
  std::size_t max_commands_in_flight = 256;               ///< unanswered commands of one client
  std::size_t max_bytes_in_flight = 8'000'000;            ///< bytes of unanswered commands
  /// Replies and events that a client has not received [bytes]. A connection that exceeds the limit
  /// is closed.
  std::size_t max_control_queue_bytes = 1024 * 1024;
  /// Memory of the messages that wait for all clients. Shared messages count once.
  std::size_t max_queue_bytes_in_all = std::size_t{256} << 20;
  std::size_t max_grabs_per_client = 10;  ///< one grab per finger
  // Messages per second of one connection, by rate class. The limits are several times the rates of
  // the viewer.
  double max_queries_per_second = 500;  ///< includes one acknowledgement per frame
  double max_controls_per_second = 200;
  double max_pointer_moves_per_second = 250;
  double max_scenes_per_second = 5;                 ///< a message can be long, and is fully checked
  double max_reads_per_second = 20;                 ///< a result can be long
  double max_message_bytes_per_second = 8'000'000;  ///< parsing takes a fifth of a processor core
  double burst_seconds = 4;                         ///< a burst may have the messages of this time
  // Costs of the reads of one client, and of all clients of a session. With 50 clients at these
  // limits, all threads of the server need about a tenth of a processor core for reads.
  double max_read_bytes_per_second = 4'000'000;
  double max_read_seconds_per_second = 0.025;  ///< processor time per second
  double max_session_read_bytes_per_second = 16'000'000;
  double max_session_read_seconds_per_second = 0.05;
  /// Refused messages per second, with the same burst. A connection that exceeds the limit is
  /// closed.
  double max_refusals_per_second = 100;
  /// Time limit for the acknowledgement of a frame. A client that does not read occupies memory.
  std::chrono::seconds frame_patience{30};
  /// Time during which a disconnected participant can be resumed.
  std::chrono::milliseconds resume_time{30'000};
  /// Time without a move after which a grab ends, so that other participants can grab the body.
  std::chrono::milliseconds grab_idle{30'000};
  /// Size of one recording, which is created in memory.
  std::size_t max_recording_bytes = std::size_t{256} << 20;
  /// Size of all files that wait for their download.
  std::size_t max_download_bytes = std::size_t{512} << 20;
  /// Time limit for a complete HTTP request or WebSocket upgrade.
  std::chrono::milliseconds handshake_time{10'000};
  /// Interval of pings. A peer that sends nothing for two intervals is disconnected.
  std::chrono::milliseconds ping_interval{20'000};
  /// Memory of the process above which new work is rejected [bytes]; 0: no limit.
  std::size_t max_memory = 0;
  std::size_t max_tokens = 10'000;  ///< valid invitations and tickets
  // Limits of saved states and scenes.
  std::size_t max_states_per_session = 20;
  std::size_t max_state_bytes_per_session = std::size_t{64} << 20;
  std::size_t max_state_bytes_in_all = std::size_t{512} << 20;
  std::size_t max_scenes_per_address = 50;
  std::size_t max_scene_bytes_per_address = std::size_t{32} << 20;
  std::size_t max_scenes_in_all = 1000;
  std::size_t max_scene_bytes_in_all = std::size_t{256} << 20;
  /// Time without participants after which a session hibernates (no ticks run); 0: never.
  std::chrono::milliseconds hibernate_after{60'000};
  /// Time without participants after which a session ends; 0: never. The first session never ends.
  std::chrono::milliseconds expire_after{24 * 3'600'000};
  /// Time without participants after which a replay ends; 0: never.
  std::chrono::milliseconds replay_expire_after{300'000};
};

/// Greatest value of the setting max_message_depth. Log entries from other settings remain
/// readable.
inline constexpr std::size_t kMaxMessageDepth = 64;

/// Limits that PROTOCOL.md specifies.
inline constexpr std::size_t kMaxTicksPerStep = 1000;
inline constexpr std::size_t kMaxFrameInterval = 100;  // [ticks]
inline constexpr double kMinSpeedFactor = 0.05;        // simulated seconds per second
inline constexpr double kMaxSpeedFactor = 4;           // simulated seconds per second
inline constexpr std::uint32_t kFrameWindow = 3;       // frames sent and not acknowledged
inline constexpr std::size_t kMaxFrameGroups = 8;      // encoded frames per state
/// 2^53: greatest range in which all JSON integers are exact.
inline constexpr std::uint64_t kMaxExactCount = 9'007'199'254'740'992;
inline constexpr std::size_t kMaxConnections = 10'000;  // springs or contacts in a reply
inline constexpr std::size_t kDefaultConnections = 2000;
inline constexpr std::size_t kMaxPresence = 100;    // participants in the result of presence.list
inline constexpr std::size_t kMaxTokenBytes = 256;  // bytes of a token in a request
inline constexpr std::size_t kMaxImportPart = 4 * 1024 * 1024;  // base64 characters of one message
inline constexpr std::uint64_t kMaxRecordedTicks = 10'000'000;  // per import; two days at 50 Hz
inline constexpr std::size_t kMaxRecordedEntries = 1'000'000;   // per import
/// Messages that exceed the limit of the control queue.
inline constexpr std::size_t kMaxLongMessages = 2;

}  // namespace vat
