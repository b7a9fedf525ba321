#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/directory/server_settings.h"
#include "server/session/session.h"
#include "server/support/owned_mutex.h"
#include "server/transport/address_counts.h"

namespace vat {

/// Stored session that is not running, because its recovery is in progress or has failed.
struct AbsentSession {
  /// Request session.join that waits for the recovery.
  struct Waiting {
    PendingReply reply;
    JoinRequest request;
  };
  std::string name;
  std::uint64_t recovery = 0;  ///< number of the recovery in progress
  bool is_lost = false;        ///< the recovery has failed; the session remains in the storage
  std::vector<Waiting> waiting;
};

/// Running and absent sessions of a server. The caller must hold the directory's lock.
class SessionRegistry {
 public:
  using Running = std::map<SessionNumber, std::shared_ptr<Session>>;
  using Absent = std::map<SessionNumber, AbsentSession>;

  explicit SessionRegistry(const OwnedMutex& mutex) : mutex_(mutex) {}

  /// Returns an unused number for a session in memory. next_replay_number() returns an unused
  /// number for a replay.
  SessionNumber next_number();
  SessionNumber next_replay_number();

  /// Adds a running session. `place` counts towards the sessions of the creator's address. Null:
  /// the server created the session.
  void add(SessionNumber number, std::shared_ptr<Session> session, AddressCounts::Place place);
  void remove(SessionNumber number);
  /// Returns whether the session is counted for this address.
  bool is_from(SessionNumber number, const std::string& address) const;
  /// Returns the running session with this id, or null.
  const Running::value_type* find(const SessionId& id) const;
  /// Returns the first running session, or null. The first session never expires.
  const Running::value_type* first() const;
  /// Returns a session, which must be running.
  Session& at(SessionNumber number) const;
  const Running& running() const;
  std::size_t replay_count() const;

  /// Adds an absent session, or starts another recovery of it. Returns the number of the recovery.
  std::uint64_t add_absent(SessionNumber number, const std::string& name);
  void remove_absent(SessionNumber number);
  /// Returns the absent session with this id, or null. Without an id, returns the first session if
  /// its recovery is in progress.
  Absent::value_type* find_absent(const std::optional<SessionId>& id);
  /// Returns the absent session if its last recovery has this number, and otherwise null: another
  /// node took the session during the recovery.
  AbsentSession* find_recovering(SessionNumber number, std::uint64_t recovery);
  AbsentSession& absent_at(SessionNumber number);
  const Absent& absent() const;
  bool is_recovering() const;

  /// Returns the number of running and absent sessions.
  std::size_t size() const;

 private:
  const OwnedMutex& mutex_;
  Running running_;
  std::map<SessionNumber, AddressCounts::Place> places_;
  Absent absent_;
  SessionNumber last_number_ = 0;
  SessionNumber last_replay_ = kFirstReplay;
  std::uint64_t last_recovery_ = 0;
};

}  // namespace vat
