#pragma once

#include <atomic>
#include <optional>
#include <variant>

#include "server/directory/client_registry.h"
#include "server/directory/server_resources.h"
#include "server/directory/session_registry.h"

namespace vat {

/// Creator of a session.
struct SessionCreator {
  ConnectionId connection = 0;  ///< connection that becomes the owner when it joins; 0: none
  /// Counts towards the sessions of the creator's address. Null: created by the server itself.
  AddressCounts::Place place;
};

/// The tables of a directory, and the lock for the tables.
struct DirectoryTables {
  mutable OwnedMutex mutex;
  ClientRegistry clients{mutex};
  SessionRegistry sessions{mutex};
};

/// Checks whether clients may create, join and change sessions. The caller must hold the
/// directory's lock.
class Admission {
 public:
  Admission(const ServerResources& resources, DirectoryTables& tables);

  /// Refuses all later connections, sessions and joins.
  void start_draining();
  bool is_draining() const;
  /// Stops the server's admission and cancels recoveries.
  void stop() { stopped_ = true; }
  /// Returns whether stop() was called. Does not require the lock.
  const std::atomic<bool>& stopped() const { return stopped_; }

  /// Returns whether a further connection is admitted.
  bool admits_connection() const;
  /// Returns an error if no further session is admitted.
  std::optional<RpcError> refuse_session() const;
  /// Returns the creator, counted for its address, or the error limit_reached. The error contains
  /// the number of abandoned sessions of the address.
  std::variant<SessionCreator, RpcError> admit_creator(const PendingReply& reply);
  std::optional<RpcError> refuse_replay() const;
  /// Returns an error if the client's token is for another session, or has not been checked.
  std::optional<RpcError> refuse_access(const Client& client, SessionNumber session) const;
  /// Returns an error if the client's role in the session is below the method's least role.
  std::optional<RpcError> refuse_role(const PendingReply& reply, SessionNumber session) const;
  /// Returns whether a running session is abandoned: it has no participant, nobody can resume one,
  /// and its creator has disconnected. The first session is never abandoned.
  bool is_abandoned(SessionNumber session) const;
  /// Returns whether the client may close the running session: as its owner, as an admin, or as a
  /// controller from the address that created the abandoned session.
  bool may_close(const Client& client, SessionNumber session) const;
  /// Returns the error for a session id without a running session.
  RpcError refuse_missing(const Client& client, const SessionId& id) const;
  /// Returns the request with the role that the client's token grants.
  JoinRequest complete(JoinRequest request, const Client& client) const;
  /// Returns the role of participants without an invitation in a new session.
  Role default_role() const;

 private:
  bool has_lock() const { return tables_.mutex.is_held(); }
  Role role_in(const Client& client, SessionNumber session) const;

  const ServerResources& resources_;
  DirectoryTables& tables_;
  AddressCounts sessions_by_address_;
  bool draining_ = false;
  std::atomic<bool> stopped_ = false;
};

}  // namespace vat
