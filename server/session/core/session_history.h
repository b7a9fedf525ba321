#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "server/history/session_log.h"
#include "server/messages/rpc_message.h"
#include "server/session/core/session_context.h"
#include "server/session/core/session_run.h"
#include "server/session/ticks/session_clock.h"

namespace vat {

/// Difference between a recovered state and the state that was stored.
struct Divergence {
  std::uint64_t position = 0;
  std::uint64_t tick = 0;
  std::string reason;
};

/// Position of a session in its log, and the log if the session is stored. Used by one thread at a
/// time.
class SessionHistory {
 public:
  SessionHistory(const SessionContext& context, const SessionRun& run, const SessionClock& clock,
                 const Participants& participants);

  /// Logs commands from now on.
  void keep_in(std::unique_ptr<SessionLog> log);
  SessionLog* log() { return log_.get(); }  ///< null: not stored
  /// Returns the log. The session is not stored any more.
  std::unique_ptr<SessionLog> end_log() { return std::move(log_); }

  std::uint64_t sequence() const { return sequence_; }  ///< of the last entry that was executed
  /// Notes that an entry is executed. In a log, sequences increase.
  void execute(const LogEntry& entry) { sequence_ = entry.sequence; }
  /// Notes that the last entry loaded the current scene.
  void mark_scene() { scene_sequence_ = sequence_; }
  void set_sequences(std::uint64_t sequence, std::uint64_t scene_sequence);

  LogEntry make_entry(ParticipantNumber participant, std::string_view method,
                      std::string params) const;
  /// Gives the entries their sequences and logs them, if the session is stored. Returns
  /// storage_failed if that fails; the entries must then not be executed.
  std::optional<RpcError> append(std::span<LogEntry> entries);
  /// Marks an entry as refused: it changed nothing.
  void refuse(const LogEntry& entry);
  /// Ensures that a recovery reaches at least the current tick, because a client is told of it.
  std::optional<RpcError> reach();

  /// The session as it is now.
  SessionMoment moment() const;

  /// Set if the session was recovered in another state, until a scene is loaded or reset.
  const std::optional<Divergence>& divergence() const { return divergence_; }
  void set_divergence(Divergence divergence) { divergence_ = std::move(divergence); }
  void clear_divergence() { divergence_.reset(); }

 private:
  const SessionContext& context_;
  const SessionRun& run_;
  const SessionClock& clock_;
  const Participants& participants_;
  std::unique_ptr<SessionLog> log_;
  std::uint64_t sequence_ = 1;        // the first entry has the scene
  std::uint64_t scene_sequence_ = 1;  // of the entry that loaded the current scene
  bool log_fails_ = false;
  std::optional<Divergence> divergence_;
};

}  // namespace vat
