#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/directory/access_control.h"
#include "server/directory/admission.h"
#include "server/directory/replay_opener.h"
#include "server/directory/server_resources.h"
#include "server/directory/session_recoverer.h"

namespace vat {

/// The sessions and clients of a server, and which client is in which session. Safe to use from any
/// thread. See server/THREADS.md.
class SessionDirectory {
 public:
  /// `catalogue` and `clock` must outlive this. Throws StorageError if the data folder cannot be
  /// used.
  SessionDirectory(const Catalogue& catalogue, ServerSettings settings, Clock& clock,
                   const SessionMethods& methods);
  ~SessionDirectory();
  SessionDirectory(const SessionDirectory&) = delete;
  SessionDirectory& operator=(const SessionDirectory&) = delete;

  ServerResources& resources() { return resources_; }
  const ServerResources& resources() const { return resources_; }
  AccessControl& access() { return access_; }
  ReplayOpener& replays() { return replays_; }

  /// Returns false if the connection is refused.
  bool connect(std::shared_ptr<Connection> connection);
  void disconnect(ConnectionId id);
  struct Sender {
    std::shared_ptr<ClientOutbox> outbox;  ///< null: not connected, or being closed
    Role role = Role::none;                ///< granted to the connection
  };
  Sender find_client(ConnectionId id) const;

  /// Starts to recover the stored sessions, and returns their number.
  std::size_t recover() { return recoverer_.start(); }
  /// False while sessions are being recovered, and after drain().
  bool is_ready() const;

  std::variant<SessionId, RpcError> create(std::string name, const Scene& scene,
                                           SessionCreator creator);
  /// Creates the session on a thread of the pool and answers. Returns an error if that is known at
  /// once.
  std::optional<RpcError> create_later(PendingReply& reply, std::string name, Json scene);
  struct Listed {
    SessionId id;
    SessionSummary summary;
    const char* state;  ///< "running"; "recovering" and "lost" have only a name
  };
  /// The sessions that the client may join.
  std::vector<Listed> list(const PendingReply& reply) const;
  /// Joins a session; without an id the first one. The session answers, also after its recovery.
  /// Returns an error if that is known at once.
  std::optional<RpcError> join(PendingReply& reply, const std::optional<SessionId>& id,
                               JoinRequest request);
  std::optional<RpcError> leave(PendingReply& reply);
  /// Posts the command to the session that the client has joined.
  std::optional<RpcError> post(PendingReply& reply, SessionCommand command);
  /// Closes a session, which answers when its work has ended.
  std::optional<RpcError> close(PendingReply& reply, const SessionId& id,
                                const std::string& reason);
  /// Returns the tick of the session that the client has joined, as of its last answer or turn.
  std::optional<std::uint64_t> tick_of(const PendingReply& reply) const;

  /// Returns the metrics for Prometheus.
  std::string metrics() const;
  /// Admits no connections, sessions and joins from now on, sends server.draining, and waits until
  /// the time is over or all clients have left.
  void drain(std::chrono::milliseconds time);
  /// Ends the server for an admin. Absent: after its default time.
  RpcResult request_drain(std::optional<std::chrono::milliseconds> time);
  /// Waits for the work posted before: creations, turns, their frames and writes.
  void flush();
  /// Ends all sessions and joins the threads.
  void stop();

 private:
  std::optional<SessionNumber> store(const std::string& name, const Scene& scene);
  RpcResult create_from(const Json& scene, std::string name, SessionCreator creator);
  void undo_join(ConnectionId id, SessionNumber session);
  void end_expired();

  // With the lock.
  std::optional<RpcError> close_absent(PendingReply& reply, const SessionId& id);
  /// Removes the session from the storage. Returns the error if that fails.
  std::optional<StorageError::Kind> forget_stored(SessionNumber number);
  void leave_session(Client& client, PendingReply reply);
  void close_session(SessionNumber number, Session::End end, const std::string& reason,
                     std::optional<PendingReply> reply);
  void remove_tokens(const SessionId& id, Session::End end);
  /// Time after which an empty session expires.
  std::chrono::milliseconds expiry_of(SessionNumber session) const;
  void end_expired_sessions(SteadyClock::time_point now);
  void wait_for_expiry();

  ServerResources resources_;
  DirectoryTables tables_;
  Admission admission_;
  AccessControl access_;
  ReplayOpener replays_;
  SessionRecoverer recoverer_;
  const std::unique_ptr<Timer> expiry_timer_;
  bool drain_time_is_over_ = false;      // guarded by the lock
  std::condition_variable_any drained_;  // the time is over, or the last client has left
};

}  // namespace vat
