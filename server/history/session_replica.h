#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/storage/checkpoint_store.h"
#include "server/storage/journal.h"
#include "server/storage/session_store.h"

namespace vat {

/// Copy of a session's log, progress and states outside the data folder, from which another machine
/// can continue the session. Changes are stored in the order of the calls. Thread-safe.
class SessionReplica {
 public:
  using Done = Journal::Done;
  SessionReplica() = default;
  virtual ~SessionReplica() = default;
  SessionReplica(const SessionReplica&) = delete;
  SessionReplica& operator=(const SessionReplica&) = delete;

  /// Stores all entries or no entry. Calls `done` after the entries survive the loss of this
  /// machine.
  virtual void append(const std::vector<LogEntry>& entries, Done done) = 0;
  /// See the functions of SessionLog with these names.
  virtual void refuse(std::uint64_t sequence) = 0;
  virtual void reach(std::uint64_t position, Done done) = 0;
  /// The failure is `name_used` if another session has the name.
  virtual void configure(const std::string& name, const std::string& settings, Done done) = 0;
  /// Stores the progress, with the participants. `done` may be empty.
  virtual void write_progress(const SessionProgress& progress, Done done) = 0;
  /// Returns a value for write_state() of a state that is taken now. A state contains the changes
  /// that were stored before.
  virtual std::uint64_t mark() const = 0;
  /// Stores a state in the background, with the log entry that loaded its scene. The state of the
  /// checkpoint must be compressed. Skips the state if an earlier one is still being stored, unless
  /// `always` is true.
  virtual void write_state(const Checkpoint& state, const LogEntry& loaded, std::uint64_t mark,
                           bool always) = 0;
  /// Calls `done` after the states and changes of all previous calls are stored or have failed.
  virtual void flush(Done done) = 0;
  /// Returns whether the log since the last state is long, so that a state should be stored.
  virtual bool needs_state() const = 0;
  /// Returns whether this machine may run the session now.
  virtual bool is_active() const = 0;
};

/// Source of the replicas of sessions.
class SessionReplicas {
 public:
  SessionReplicas() = default;
  virtual ~SessionReplicas() = default;
  SessionReplicas(const SessionReplicas&) = delete;
  SessionReplicas& operator=(const SessionReplicas&) = delete;

  /// Returns the replica of a session, which this machine must own. Never null.
  virtual std::shared_ptr<SessionReplica> replica_of(std::uint64_t session) = 0;
};

}  // namespace vat
