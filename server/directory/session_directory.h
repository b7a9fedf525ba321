#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "protocol/scene/level.h"
#include "server/cluster/cluster_host.h"
#include "server/directory/access_control.h"
#include "server/directory/admission.h"
#include "server/directory/listed_session.h"
#include "server/directory/replay_opener.h"
#include "server/directory/server_resources.h"
#include "server/directory/session_recoverer.h"

namespace vat {

/// Sessions and clients of a server, and the assignment of clients to sessions. Thread-safe. See
/// server/THREADS.md.
class SessionDirectory : private ClusterHost {
 public:
  /// `catalogue` and `clock` must outlive the directory. Throws StorageError if the data folder
  /// cannot be used.
  SessionDirectory(const Catalogue& catalogue, ServerSettings settings, Clock& clock,
                   const SessionMethods& methods);
  ~SessionDirectory() override;
  SessionDirectory(const SessionDirectory&) = delete;
  SessionDirectory& operator=(const SessionDirectory&) = delete;

  ServerResources& resources() { return resources_; }
  const ServerResources& resources() const { return resources_; }
  AccessControl& access() { return access_; }
  ReplayOpener& replay_opener() { return replay_opener_; }

  /// Adds a connection. Returns false if the connection is refused. If another node relays the
  /// client, `access` is the access that the client has there.
  bool connect(std::shared_ptr<Connection> connection, const std::optional<Grant>& access = {});
  void disconnect(ConnectionId id);
  struct Sender {
    std::shared_ptr<ClientOutbox> outbox;  ///< null: not connected, or closing
    Role role = Role::none;                ///< role granted to the connection
    std::shared_ptr<RelayedClient> relay;  ///< null: the client is in no session of another node
  };
  /// Returns the sender of a message.
  Sender find_client(ConnectionId id);

  /// Starts the recovery of the stored sessions and returns their number. A node of a cluster
  /// enters the cluster instead, and returns the number of the cluster's sessions. Throws
  /// NatsError.
  std::size_t recover();
  /// Returns false during the recovery of sessions and after drain().
  bool is_ready() const;
  /// Returns whether another process is now this node of the cluster.
  bool is_replaced() const;

  /// Creates a session. May wait for the disk.
  std::variant<SessionId, RpcError> create(std::string name, const Scene& scene,
                                           SessionCreator creator);
  /// Answers with the result of `work`, which may wait for the disk.
  void use_storage(PendingReply& reply, std::function<RpcResult()> work);
  /// Creates a session on a storage thread, and then answers. Errors that are known immediately
  /// are returned instead.
  std::optional<RpcError> create_later(PendingReply& reply, std::string name, Json scene,
                                       Level level);
  /// Returns the sessions that the client may join.
  std::vector<ListedSession> list(const PendingReply& reply) const;
  /// Calls `done` later with the descriptions of the sessions on the other nodes of the cluster:
  /// describe_session() with add_people(). Nodes that do not answer are missing.
  void describe_elsewhere(std::function<void(const std::map<SessionId, Json>&)> done);
  /// Joins a session, or the first session if `id` is absent. The session answers, if necessary
  /// after its recovery. Errors that are known immediately are returned instead.
  std::optional<RpcError> join(PendingReply& reply, const std::optional<SessionId>& id,
                               JoinRequest request);
  std::optional<RpcError> leave(PendingReply& reply);
  /// Sends the command to the session that the client has joined.
  std::optional<RpcError> post(PendingReply& reply, SessionCommand command);
  /// Closes a session. The session answers after its work has ended.
  std::optional<RpcError> close(PendingReply& reply, const SessionId& id,
                                const std::string& reason);
  /// Hands a session over to another node of the cluster. Answers after its state is stored.
  std::optional<RpcError> move(PendingReply& reply, const SessionId& id, const std::string& node);
  /// Sends a request about the session that its parameters name to the owner of the session, or
  /// answers with the error `moved`. Returns false if another node does not have the session.
  bool ask_owner(PendingReply& reply, const RpcRequest& request);
  /// Returns the function that notes a result of replay.open on another node, see NoteResult of
  /// RelayedClient.
  std::function<void(Json& result)> note_replay_of(ConnectionId creator);
  /// Implement RelayHost::Server.
  bool watch(const std::shared_ptr<ClientOutbox>& viewer, const SessionId& id,
             const Subscription& wanted);
  void unwatch(const SessionId& id, std::shared_ptr<ClientOutbox> viewer);
  /// Sets a function that is called often, and after each change of the cluster's sessions. Call it
  /// before recover().
  void on_cluster_change(std::function<void()> function) { cluster_change_ = std::move(function); }
  /// Returns the tick of the client's session at the time of the session's last reply or turn.
  std::optional<std::uint64_t> tick_of(const PendingReply& reply) const;

  /// Returns the metrics in the text format of Prometheus.
  std::string metrics();
  /// Returns the state of the storage, for /healthz.
  Json health() const;
  /// Refuses new connections, sessions and joins, and sends server.draining. Returns after `time`,
  /// or as soon as all clients have left.
  void drain(std::chrono::milliseconds time);
  /// Ends the server at the request of an admin. Uses the default time if `time` is absent.
  RpcResult request_drain(std::optional<std::chrono::milliseconds> time);
  /// Waits for all previously posted work: creations, turns, their frames, and writes.
  void flush();
  /// Ends all sessions and joins the threads.
  void stop();

 private:
  /// A new session in the storage.
  struct Stored {
    SessionNumber number = 0;
    std::size_t log_bytes = 0;
  };
  std::optional<Stored> store(const std::string& name, const Scene& scene,
                              InstructionSet instructions);
  /// Removes a stored session that no client knows.
  void remove_stored(SessionNumber number);
  InstructionSet instructions_for_new() const;

  // Implemented in session_directory_cluster.cpp and session_directory_relay.cpp.
  void start_taken(const StoredSession& session) override;
  void end_lost(std::uint64_t session, const std::string& url, std::function<void()> done) override;
  bool stop_for_move(std::uint64_t session, std::function<void()> done) override;
  void create_for(const std::string& request,
                  std::function<void(const std::string&)> answer) override;
  std::map<std::uint64_t, std::string> replays() const override;
  std::map<std::uint64_t, std::string> describe_sessions() const override;
  void cluster_changed() override;
  /// Answers with a session that was created for another node, and a ticket for its owner.
  void answer_created(const SessionId& id, const std::function<void(const std::string&)>& answer);
  /// Creates the session on another node of the cluster, if one has more room. Waits.
  std::optional<RpcResult> create_elsewhere(const Json& scene, Level level,
                                            const std::string& name);
  /// As join(). If `may_wait` is false, does not wait for an unknown replay.
  std::optional<RpcError> join_or_wait(PendingReply& reply, const std::optional<SessionId>& id,
                                       JoinRequest request, bool may_wait);
  /// Returns the error for a session on another node. If the session has no owner now, the request
  /// waits for one, and the function returns nothing. `is_missing` is set if there is no session.
  std::optional<RpcError> join_elsewhere(PendingReply& reply, const std::optional<SessionId>& id,
                                         JoinRequest& request, bool& is_missing);
  /// If the id is that of a replay, keeps the request until the other nodes have told their
  /// replays. Returns false otherwise.
  bool wait_for_replay(PendingReply& reply, const std::optional<SessionId>& id,
                       JoinRequest& request);
  /// Returns a session of the cluster that this node does not own.
  std::optional<LocatedSession> find_elsewhere(const std::optional<SessionId>& id) const;
  void add_elsewhere(const Client& client, std::vector<ListedSession>& list) const;
  /// Remembers the ticket for a session that the client has created on another node.
  void keep_ticket(ConnectionId creator, const RpcResult& created);
  /// Returns whether the owner of a session may accept a client. It may be stopping, or may have
  /// the session no longer.
  bool can_relay(const LocatedSession& session) const;
  /// Returns the owner of a session of the cluster, or nothing if there is no such session. An
  /// owner without a lease has no name.
  std::optional<RelayDoor::Owner> present_owner(const SessionId& id) const;
  void note_granted(ConnectionId id, const SessionId& session, const Grant& grant);
  void send_request(const Client& client, PendingReply& reply, const RpcRequest& request,
                    const SessionId& session, const RelayDoor::Owner& owner,
                    RelayedRequest::NoteResult note);
  /// Returns the access that the owner of a session checks or grants.
  RelayEntry entry_for(const Client& client, const SessionId& id,
                       const std::optional<std::string>& resume);
  /// Joins a session of another node, which serves the client through this node.
  void join_by_relay(Client& client, PendingReply& reply, const LocatedSession& session,
                     const JoinRequest& request);
  void tell_moved(SessionNumber number, const std::string& url);
  /// Measures and estimates the memory by use.
  ServerMetrics::Memory memory_use();
  RpcResult create_from(const Json& scene, Level level, std::string name, SessionCreator creator);
  void undo_join(ConnectionId id, SessionNumber session);
  void end_expired();

  // The caller must hold the lock for these functions.
  std::optional<RpcError> close_absent(PendingReply& reply, const SessionId& id);
  /// Closes the stored session, if it is stored, and then calls `then`. If the storage is not used,
  /// calls `then` at once. `then` holds the lock.
  void forget_stored_then(SessionNumber number,
                          std::function<void(std::optional<StorageError::Kind>)> then);
  void leave_session(Client& client, PendingReply reply);
  void close_session(SessionNumber number, Session::End end, const std::string& reason,
                     std::optional<PendingReply> reply);
  void remove_tokens(const SessionId& id, Session::End end);
  /// Returns the time after which an empty session expires.
  std::chrono::milliseconds expiry_of(SessionNumber session) const;
  void end_expired_sessions(SteadyClock::time_point now);
  void wait_for_expiry();
  /// Closes clients if the queues of all clients are too long. Checks this once per second.
  void bound_queues();

  ServerResources resources_;
  DirectoryTables tables_;
  Admission admission_;
  AccessControl access_;
  ReplayOpener replay_opener_;
  SessionRecoverer recoverer_;
  const std::unique_ptr<Timer> expiry_timer_;
  SteadyClock::time_point queue_check_{};  // next check of the queues; guarded by the lock
  bool drain_time_is_over_ = false;        // guarded by the lock
  /// Requests session.join for sessions without an owner; guarded by the lock.
  struct WaitingJoin {
    SessionId id;
    AbsentSession::Waiting join;
  };
  std::vector<WaitingJoin> waiting_joins_;
  std::function<void()> cluster_change_;
  std::condition_variable_any drained_;  // signals the end of the time or of the last client
};

}  // namespace vat
