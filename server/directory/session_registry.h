#pragma once

#include <cstddef>
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

/// A stored session that is not running: it is being recovered, or its recovery has failed.
struct AbsentSession {
  /// A session.join that waits for the recovery.
  struct Waiting {
    PendingReply reply;
    JoinRequest request;
  };
  std::string name;
  bool is_lost = false;  ///< the recovery has failed; the session stays in the storage
  std::vector<Waiting> waiting;
};

/// The sessions of a server, running and absent. The caller must hold the directory's lock.
class SessionRegistry {
 public:
  using Running = std::map<SessionNumber, std::shared_ptr<Session>>;
  using Absent = std::map<SessionNumber, AbsentSession>;

  explicit SessionRegistry(const OwnedMutex& mutex) : mutex_(mutex) {}

  /// Returns a number that no session had: of a session in memory, or of a replay.
  SessionNumber next_number();
  SessionNumber next_replay_number();

  /// `place` counts towards the sessions of its creator's address; null: the server's own.
  void add(SessionNumber number, std::shared_ptr<Session> session, AddressCounts::Place place);
  void remove(SessionNumber number);
  /// Returns null if no running session has the id.
  const Running::value_type* find(const SessionId& id) const;
  /// Returns null if there is no running session. The first never expires.
  const Running::value_type* first() const;
  /// The session must be running.
  Session& at(SessionNumber number) const;
  const Running& running() const;
  std::size_t replay_count() const;

  void add_absent(SessionNumber number, const std::string& name);
  void remove_absent(SessionNumber number);
  /// Returns null if no absent session has the id. Without an id: the first session, if it is being
  /// recovered.
  Absent::value_type* find_absent(const std::optional<SessionId>& id);
  AbsentSession& absent_at(SessionNumber number);
  const Absent& absent() const;
  bool is_recovering() const;

  /// Running and absent.
  std::size_t size() const;

 private:
  const OwnedMutex& mutex_;
  Running running_;
  std::map<SessionNumber, AddressCounts::Place> places_;
  Absent absent_;
  SessionNumber last_number_ = 0;
  SessionNumber last_replay_ = kFirstReplay;
};

}  // namespace vat
