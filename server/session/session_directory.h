#pragma once

#include <atomic>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/access/access.h"
#include "server/http/downloads.h"
#include "server/net/address_counts.h"
#include "server/replay/imports.h"
#include "server/session/deferred_tasks.h"
#include "server/session/session.h"
#include "server/session/session_server.h"

namespace vat {

/// Sessions with such numbers show recordings, and end with the server.
inline constexpr std::uint64_t kFirstReplay = std::uint64_t{1} << 62;

/// The id of the session with this number.
SessionId to_id(std::uint64_t number);

/// Who has a session made.
struct SessionCreator {
  ConnectionId connection = 0;  ///< who is its owner once it joins; 0: nobody is
  AddressCounts::Place place;   ///< among the sessions of its address; null: the server's own
};

/// What users save where there is no data folder: it ends with the server.
struct SavedInMemory {
  SavedStates states{MainDatabase::kInMemory};
  SavedScenes scenes{std::make_shared<MainDatabase>(MainDatabase::kInMemory)};
};

/// The sessions, the clients and who is in which; owns the threads. Safe to use from any thread.
class SessionDirectory {
 public:
  SessionDirectory(const Catalogue& catalogue, ServerSettings settings, Clock& clock);
  ~SessionDirectory();

  const Catalogue& catalogue() const { return catalogue_; }
  const ServerSettings& settings() const { return settings_; }
  const Clock& clock() const { return clock_; }

  /// False if there are too many already.
  bool connect(std::shared_ptr<Connection> connection);
  void disconnect(ConnectionId id);
  /// Who has sent a message.
  struct Sender {
    std::shared_ptr<ClientOutbox> outbox;  ///< null: it is not connected, or is being closed
    Role role = Role::none;                ///< which it was let in with
  };
  Sender find_client(ConnectionId id) const;

  /// Lets the client in anew, with what the token gives; answered at once, or later where the token
  /// is not good.
  std::optional<RpcResult> enter(PendingReply& caller, std::string_view token);
  /// A token for one use, soon. Without a session, which is an admin's to give, it is good in all.
  RpcResult issue_ticket(const PendingReply& caller, Role role,
                         const std::optional<SessionId>& session);

  /// Brings back what is stored, in the background; how many sessions that is.
  std::size_t recover();
  /// Whether none is under way to come back.
  bool is_ready() const;

  std::variant<SessionId, RpcError> create(std::string name, const Scene& scene,
                                           SessionCreator creator);
  /// Reads the scene and creates the session on a thread of the pool, one at a time, and answers
  /// there; or gives the error at once.
  std::optional<RpcError> create_later(PendingReply& caller, std::string name, Json scene);

  struct Listed {
    SessionId id;
    SessionSummary summary;
    const char* state;  ///< "running", or, with a name and nothing else, "recovering" or "lost"
  };
  /// Those that are open to the caller.
  std::vector<Listed> list(const PendingReply& caller) const;
  /// Answered by the session, or by the error that is returned. Without an id: the first session.
  /// Who asks for one that is coming back waits for it.
  std::optional<RpcError> join(PendingReply& caller, const std::optional<SessionId>& id,
                               JoinRequest join_request);
  std::optional<RpcError> leave(PendingReply& caller);
  /// Hands the command to the session that the caller is in.
  std::optional<RpcError> post(PendingReply& caller, SessionCommand command);
  /// Answered by the session once its work has ended, or by the error that is returned.
  std::optional<RpcError> close(PendingReply& caller, const SessionId& id,
                                const std::string& reason);
  /// The tick of the session that the caller is in, as of its last answer or turn; none outside.
  std::optional<std::uint64_t> tick_of(const PendingReply& caller) const;

  /// A part of a file that a client brings. The last part is answered once the whole is read.
  std::optional<RpcResult> import_recording(PendingReply& caller, const Imports::Part& part);
  /// What a replay is to show: a session that is kept, or a recording that was imported.
  struct ReplaySource {
    std::optional<SessionId> session;
    std::optional<std::string> recording;
    std::string name;  ///< of the new session; empty: the recording's
  };
  /// Makes a session that shows it, and answers with its id; or gives the error at once.
  std::optional<RpcError> open_replay(PendingReply& caller, const ReplaySource& source);

  ServerMetrics& counters() { return metrics_; }
  /// What Prometheus is told.
  std::string metrics() const;

  /// Refuses new connections, sessions and joins from now on. Tells clients that the server ends in
  /// `time`. Returns when the time is over or the last client has gone.
  void drain(std::chrono::milliseconds time);
  /// As an admin wishes: the server ends once clients have had so much time (absent: as much as it
  /// gives them by itself). How much that is.
  RpcResult request_drain(std::optional<std::chrono::milliseconds> time);

  SavedScenes& saved_scenes() const { return *environment_.scenes; }

  /// Files that were made for clients.
  Downloads& downloads() { return downloads_; }

  /// See SessionServer.
  void flush();

  void stop();

 private:
  using Sessions = std::map<std::uint64_t, std::shared_ptr<Session>>;  // by the number in the id
  struct Client {
    std::shared_ptr<ClientOutbox> outbox;
    Sessions::key_type session = 0;  // 0: none
    Grant access;
    std::size_t wrong_tokens = 0;
  };

  /// A session that is stored and not here.
  struct Absent {
    struct Waiting {
      PendingReply caller;
      JoinRequest join_request;
    };
    std::string name;
    bool is_lost = false;  ///< it could not be brought back, and stays in the storage
    std::vector<Waiting> waiting;
  };

  /// The number of a new session that is kept; nothing where it is not.
  std::optional<std::uint64_t> store(const std::string& name, const Scene& scene);
  /// A session that is kept does not come back; or why that could not be written.
  std::optional<StorageError::Kind> forget_session(Sessions::key_type number);
  void remove_tokens(const SessionId& id, Session::End end);
  void recover_session(const StoredSession& stored);
  /// Makes it, or tells why it is lost.
  std::shared_ptr<Session> make_recovered(const StoredSession& stored);
  void end_recovery(const StoredSession& stored, std::shared_ptr<Session> session);
  /// Of who joins a session without an invitation, unless its owner says otherwise.
  Role default_role() const;
  RpcResult create_from(const Json& scene, std::string name, SessionCreator creator);
  /// Why there can be no further session, if so.
  std::optional<RpcError> refuse_session() const;

  /// The token's, if it is good.
  std::optional<Grant> find_grant(std::string_view token);
  void close_unless_entered(ConnectionId id);
  /// Sessions, and files that nobody has fetched or gone on with.
  void end_expired();
  void undo_join(ConnectionId id, Sessions::key_type session);

  RpcResult take_recording(const std::string& name, std::size_t size);
  void answer_replay(PendingReply caller, std::shared_ptr<const Recording> recording,
                     const std::string& name, SessionCreator creator);
  RpcResult make_replay(std::shared_ptr<const Recording> recording, const std::string& name,
                        SessionCreator creator);

  // With the mutex held.
  void end_expired_sessions(SteadyClock::time_point now);
  /// With a session that nobody is in.
  std::chrono::milliseconds patience_with(Sessions::key_type session) const;
  std::optional<RpcError> refuse_source(const PendingReply& caller, const Client& client,
                                        const ReplaySource& source);
  void record_and_open(PendingReply& caller, const ReplaySource& source, SessionCreator creator);
  std::size_t replay_count() const;
  void wait_for_expiry();
  const Client* find_caller(const PendingReply& caller) const;
  /// Why the caller may not call a method that names this session, if so.
  std::optional<RpcError> refuse_role(const PendingReply& caller, const MethodRules& rules,
                                      Sessions::key_type session) const;
  std::optional<RpcError> refuse_access(const Client& client, Sessions::key_type session) const;
  JoinRequest complete(JoinRequest join_request, const Client& client) const;
  Sessions::iterator find_session(const SessionId& id);
  std::map<Sessions::key_type, Absent>::iterator find_absent(const std::optional<SessionId>& id);
  std::optional<RpcError> wait_for(Absent& absent, const SessionId& id, PendingReply& caller,
                                   JoinRequest join_request);
  /// Of one that is not in `sessions_`.
  RpcError refuse_missing(const Client& client, const SessionId& id);
  std::optional<RpcError> close_absent(const SessionId& id, PendingReply& caller);
  std::size_t client_count(Sessions::key_type session) const;
  void leave_session(Client& client, PendingReply caller);
  /// The caller, if there is one, is answered by the session.
  void close_session(Sessions::iterator session, Session::End end, const std::string& reason,
                     std::optional<PendingReply> caller);
  std::optional<RpcError> refuse_session_locked() const;

  const Catalogue& catalogue_;
  const ServerSettings settings_;
  // What outlives the sessions. The runner's threads help with their steps as far as the
  // pool's have nothing to do.
  ThreadPoolRunner runner_;
  Clock& clock_;
  ServerMetrics metrics_;
  AccessTokens tokens_;
  ResourceBudget resources_;
  SlowTickGate slow_tick_gate_;
  boost::asio::thread_pool frame_threads_;
  Downloads downloads_{settings_.limits.max_download_bytes};
  Imports imports_;
  const std::unique_ptr<Storage> storage_;                // null: sessions are in memory alone
  const std::unique_ptr<SavedInMemory> saved_in_memory_;  // null: in the storage
  const SessionEnvironment environment_;
  // Of sessions that come back: what was within the limits once is let in again.
  const ServerLimits no_limits_;
  ResourceBudget past_resources_;
  const SessionEnvironment past_environment_;
  boost::asio::thread_pool pool_;
  const std::shared_ptr<DeferredTasks> deferred_;
  // Creations come one after the other: they take one thread from the sessions at most.
  boost::asio::strand<boost::asio::thread_pool::executor_type> creations_;

  mutable std::mutex mutex_;
  std::map<ConnectionId, Client> clients_;
  Sessions sessions_;
  AddressCounts sessions_by_address_;
  std::map<Sessions::key_type, AddressCounts::Place> places_;  // of the sessions' creators
  const std::unique_ptr<Timer> expiry_timer_;
  std::map<Sessions::key_type, Absent> absent_;
  Sessions::key_type last_session_ = 0;  // of those in memory alone
  Sessions::key_type last_replay_ = kFirstReplay;
  bool draining_ = false;
  bool drain_time_is_over_ = false;
  std::condition_variable drained_;
  std::atomic<bool> stopped_ = false;
  std::unique_ptr<boost::asio::thread_pool> recovery_threads_;
};

}  // namespace vat
