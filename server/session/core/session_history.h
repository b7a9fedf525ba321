#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "server/history/session_log.h"
#include "server/messages/rpc_message.h"
#include "server/session/core/session_context.h"
#include "server/session/core/session_run.h"
#include "server/session/ticks/session_clock.h"

namespace vat {

/// Difference between the recovered state and the stored state of a session.
struct Divergence {
  std::uint64_t position = 0;
  std::uint64_t tick = 0;
  std::string reason;
};

/// Position of a session in its log, and the log if the session is stored. Not thread-safe.
class SessionHistory {
 public:
  SessionHistory(const SessionContext& context, const SessionRun& run, const SessionClock& clock,
                 const Participants& participants);

  /// Logs all later commands in `log`.
  void keep_in(std::unique_ptr<SessionLog> log);
  SessionLog* log() { return log_.get(); }  ///< null: session is not stored
  /// Returns the log. The session is then no longer stored.
  std::unique_ptr<SessionLog> end_log() { return std::move(log_); }

  std::uint64_t sequence() const { return sequence_; }  ///< sequence of the last executed entry
  /// Sets the sequence of the last executed entry. Sequences increase in a log.
  void execute(const LogEntry& entry) { sequence_ = entry.sequence; }
  /// Marks the last executed entry as the entry that loaded the current scene.
  void mark_scene() { scene_sequence_ = sequence_; }
  void set_sequences(std::uint64_t sequence, std::uint64_t scene_sequence);
  /// Returns the sequence of the entry that loaded the current scene.
  std::uint64_t scene_sequence() const { return scene_sequence_; }
  /// Returns the points among which the governor may choose. Empty unless the owner has permitted
  /// it for the current scene.
  std::span<const GovernorPoint> governor_points() const;

  LogEntry make_entry(ParticipantNumber participant, std::string_view method,
                      std::string params) const;
  /// Assigns sequences to the entries, which must be executed next or never. If the session is
  /// stored, also stores a checkpoint that the entries need.
  void number(std::span<LogEntry> entries);
  /// Notes the result of a write to the log. Returns storage_failed if the write failed.
  std::optional<RpcError> note_write(std::optional<StorageError::Kind> failure);
  /// Returns the error of the last write, if the write failed.
  const std::optional<StorageError::Kind>& failing() const { return failing_; }
  /// Returns true once after each change of failing().
  bool take_failing_change() { return std::exchange(failing_changed_, false); }
  /// Marks an entry as refused. A refused entry had no effect.
  void refuse(const LogEntry& entry);

  /// Returns the current state of the session.
  SessionMoment moment() const;

  /// Returns the difference that a recovery has found. Loading or resetting a scene clears the
  /// difference.
  const std::optional<Divergence>& divergence() const { return divergence_; }
  void set_divergence(Divergence divergence) { divergence_ = std::move(divergence); }
  void clear_divergence() { divergence_.reset(); }

 private:
  const SessionContext& context_;
  const SessionRun& run_;
  const SessionClock& clock_;
  const Participants& participants_;
  std::unique_ptr<SessionLog> log_;
  std::uint64_t sequence_ = 1;        // the first entry contains the scene
  std::uint64_t scene_sequence_ = 1;  // sequence of the entry that loaded the current scene
  std::optional<StorageError::Kind> failing_;
  bool failing_changed_ = false;
  std::optional<Divergence> divergence_;
};

}  // namespace vat
