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
  ConnectionId connection = 0;  ///< becomes the owner when it joins; 0: none
  AddressCounts::Place place;   ///< among the sessions of its address; null: the server's own
};

/// The tables of a directory, and the lock that guards them.
struct DirectoryTables {
  mutable OwnedMutex mutex;
  ClientRegistry clients{mutex};
  SessionRegistry sessions{mutex};
};

/// Decides which clients may create, join and change sessions. The caller must hold the directory's
/// lock.
class Admission {
 public:
  Admission(const ServerResources& resources, DirectoryTables& tables);

  /// Admits no connections, sessions and joins from now on.
  void start_draining();
  bool is_draining() const;
  /// Also cancels recoveries.
  void stop() { stopped_ = true; }
  /// May be called without the lock.
  const std::atomic<bool>& stopped() const { return stopped_; }

  /// Whether a further connection is admitted.
  bool admits_connection() const;
  /// Returns the error if no further session is admitted.
  std::optional<RpcError> refuse_session() const;
  /// Returns the creator, counted for its address, or limit_reached.
  std::variant<SessionCreator, RpcError> admit_creator(const PendingReply& reply);
  std::optional<RpcError> refuse_replay() const;
  /// Returns the error if the client's token is for another session.
  std::optional<RpcError> refuse_access(const Client& client, SessionNumber session) const;
  /// Returns the error if the client's role in the session is below the method's least role.
  std::optional<RpcError> refuse_role(const PendingReply& reply, SessionNumber session) const;
  /// Returns the error for an id that no running session has.
  RpcError refuse_missing(const Client& client, const SessionId& id) const;
  /// Adds the role that the client's token grants.
  JoinRequest complete(JoinRequest request, const Client& client) const;
  /// Role of participants without an invitation in a new session.
  Role default_role() const;

 private:
  bool has_lock() const { return tables_.mutex.is_held(); }

  const ServerResources& resources_;
  DirectoryTables& tables_;
  AddressCounts sessions_by_address_;
  bool draining_ = false;
  std::atomic<bool> stopped_ = false;
};

}  // namespace vat
