#pragma once

#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/support/instruction_set.h"
#include "server/clients/send_gate.h"
#include "server/cluster/cluster_host.h"
#include "server/cluster/cluster_settings.h"
#include "server/cluster/cluster_streams.h"
#include "server/cluster/cluster_tokens.h"
#include "server/cluster/lease.h"
#include "server/cluster/node_table.h"
#include "server/cluster/saved/cluster_scenes.h"
#include "server/cluster/saved/cluster_states.h"
#include "server/cluster/session_locator.h"
#include "server/cluster/session_stream.h"
#include "server/history/session_replica.h"
#include "server/storage/storage.h"

namespace vat {

/// This server as a node of a cluster: its lease, its entry in the list of nodes, and the sessions
/// that it owns, takes and hands over. See server/CLUSTER.md. Thread-safe.
class ClusterNode final : public SessionReplicas, public SendGate {
 public:
  /// Connects to NATS. Throws NatsError if it cannot be reached, and StorageError if the data
  /// folder has the sessions of a server without a cluster. `storage` and `clock` must outlive the
  /// node. `cores` is the number of cores for sessions.
  ClusterNode(ClusterSettings settings, Storage& storage, Clock& clock, double cores,
              const std::string& version);
  ~ClusterNode() override;

  /// Enters the cluster, and takes the sessions that the node owned before. Returns the number of
  /// the cluster's sessions. Waits until an earlier process with the node's name has no lease.
  /// Throws NatsError. `host` must outlive the call of stop().
  std::size_t start(ClusterHost& host);
  /// Takes no further sessions, and ends the renewals of the lease. Sessions can still be stored.
  void leave();
  /// As leave(), and ends the connection. The node calls no function of the host afterwards.
  void stop();

  bool is_open() const override { return lease_.is_valid(); }
  std::shared_ptr<SessionReplica> replica_of(std::uint64_t session) override;

  const std::string& name() const { return settings_.node; }
  /// Returns false if another process has the node's name. This process then serves no session.
  bool has_name() const { return has_name_; }
  /// Returns a text that differs from that of all other runs of a node.
  const std::string& instance() const { return instance_; }
  const std::string& public_url() const { return settings_.public_url; }
  /// Returns a separate connection for relays, so that frames do not delay leases and logs.
  NatsConnection& relay_connection() { return relay_connection_; }
  /// Returns whether a node takes new clients, because it does not stop.
  bool accepts(const std::string& node) const {
    const auto found = nodes_.find(node);
    return found && found->accepts;
  }
  /// Returns whether another node may still have its lease.
  bool is_present(const std::string& node) const {
    return nodes_.is_seen_within(node, Lease::kOthersTime);
  }
  /// Returns the instruction set that all present nodes have, at most `greatest`.
  InstructionSet common_instructions(InstructionSet greatest) const;
  /// Adds a new session with its first log entry, owned by this node. Returns its number. Waits.
  /// Throws NameInUse or another NatsError.
  std::uint64_t add_session(const std::string& name, const std::string& instruction_set,
                            const std::string& settings, const LogEntry& first);
  /// Removes a session of this node from the cluster, and then calls `done`.
  void remove_session(std::uint64_t session,
                      std::function<void(std::optional<StorageError::Kind>)> done);

  /// Returns the sessions of the cluster.
  std::vector<LocatedSession> sessions() const { return locator_.all(); }
  /// Returns the replays of the other nodes.
  std::vector<LocatedSession> replays() const;
  /// Returns a session of the cluster, or a replay of another node.
  std::optional<LocatedSession> find(std::uint64_t session) const;
  /// Returns a number that no other session of the cluster has. Waits. Throws NatsError.
  std::uint64_t new_number() { return locator_.next_number(); }
  /// Asks the other present nodes for their replays, and then calls `done` on a thread that may
  /// wait: after the last answer, or after ClusterSettings::answer_time if a node does not answer.
  /// Calls at the same time share the questions.
  void refresh_replays(std::function<void()> done);
  using Descriptions = std::map<std::uint64_t, std::string>;
  /// Asks the other present nodes for the results of ClusterHost::describe_sessions(), and then
  /// calls `done` with all answers, as above.
  void describe_sessions(std::function<void(const Descriptions&)> done);
  /// Returns the time within which each present node renews its entry.
  std::chrono::milliseconds entry_age() const { return renewal_.load() * 3 / 2; }
  /// Returns the URL of the session's owner, or nothing if it is unknown or silent.
  std::optional<std::string> url_of(const LocatedSession& session) const;
  /// Returns the tokens that all nodes share, or null if the settings have no key.
  SharedTokens* tokens() const { return tokens_.get(); }
  /// Return the saved states and scenes that all nodes share.
  SavedStates& saved_states() { return saved_states_; }
  SavedScenes& saved_scenes() { return saved_scenes_; }
  /// Returns the URLs of the present nodes.
  std::vector<std::string> urls() const;
  /// Returns the name of the node that should run a new session.
  std::string best_node() const;
  /// Asks another node to create a session. Waits. Returns its answer. Throws NatsError.
  std::string create_at(const std::string& node, const std::string& request);

  enum class MoveRefusal {
    not_owned,           ///< the node does not own the session
    not_present,         ///< the other node takes no sessions
    lacks_instructions,  ///< the other node lacks the instruction set of the session
    is_moving,           ///< the session is being handed over to another node than the named one
  };
  using Moved = std::function<void(const std::optional<std::string>& url)>;
  /// Hands a session over to another node. Then calls `done` with the URL of that node, or with
  /// nothing if the node cannot change the directory. If the node refuses the hand-over, returns
  /// the reason, and does not call `done`.
  std::optional<MoveRefusal> move(std::uint64_t session, const std::string& node, Moved done);
  /// Hands all sessions over to other nodes. Returns after `time`, or when all are stored.
  void drain(std::chrono::milliseconds time);

 private:
  struct Hosted {
    std::shared_ptr<SessionStream> stream;
    LocatedSession entry;
  };
  /// Hand-over that has begun.
  struct Move {
    std::string successor;
    std::vector<Moved> waiting;
  };
  using Time = SteadyClock::time_point;

  void check_data_folder() const;
  /// Writes the node's entry. Waits until an earlier process with the name has no lease.
  void claim_name();
  /// Finds out which process the node's entry describes. Waits.
  void check_name();
  void drop_foreign_sessions();
  NodeInfo describe() const;
  void listen();

  /// Returns the time within which a running node renews its lease.
  std::chrono::milliseconds fresh() const { return renewal_.load() + Lease::kGreatestRenewal; }

  // Questions to other nodes.
  struct Questions;
  void ask(const std::shared_ptr<Questions>& questions, const std::string& node,
           const std::string& question);
  /// Asks all other present nodes.
  void ask_all(std::shared_ptr<Questions> questions, const std::string& question);
  void ask_for_replays();
  void answer(const NatsMessage& question);
  std::string answer_to(const std::string& question) const;

  // On the timer's thread.
  void wait_for_tick();
  void tick();
  void renew(Time now);
  /// Renews the lease in the spare bucket.
  void renew_spare(Time now);
  void note_renewal(Time sent);
  void note_failed_renewal(const NatsError& error);
  void look_at_change(std::uint64_t session);
  /// Looks at the sessions of this node, released ones, and those of silent nodes.
  void look_at_sessions(Time now);
  void look_at(const LocatedSession& entry);
  bool is_wanted(const LocatedSession& entry);
  bool is_my_turn(const LocatedSession& entry, SteadyClock::duration orphaned) const;

  // On the threads that may wait.
  /// Returns whether the directory has the session.
  bool has_session(const std::string& id);
  void remove_saved(std::uint64_t session);
  void refresh();
  /// Lets different servers lead a stream and its spare stream.
  void separate_leaders();
  void check_sessions(Time sent);
  void take(std::uint64_t session);
  bool is_silent(const std::string& node);
  void lose(std::uint64_t session);
  /// Ends a session that the node does not host any more, and then permits that the node takes it
  /// again.
  void end_lost(std::uint64_t session, const std::string& url);
  /// Returns false if the session is not hosted.
  bool forget(std::uint64_t session);
  void release(std::uint64_t session, const std::string& successor);
  /// Calls the functions that wait for the hand-over of the session.
  void end_move(std::uint64_t session, const std::optional<std::string>& url);
  /// Calls `done` after the hand-over of the session. Returns false if no hand-over has begun.
  bool wait_for_move(std::uint64_t session, const Moved& done);
  /// Changes the entry of a hosted session. Throws NatsError if the session is lost.
  LocatedSession update(std::uint64_t session,
                        const std::function<LocatedSession(const LocatedSession&)>& change);

  std::shared_ptr<SessionStream> make_stream(SessionStream::Place place);
  /// Prevents that the node takes or loses the session, until as many calls of unreserve().
  void reserve(std::uint64_t session);
  void unreserve(std::uint64_t session);
  std::optional<Hosted> find_hosted(std::uint64_t session) const;
  void post(std::function<void()> task);
  void measure_load(Time now);

  const ClusterSettings settings_;
  Storage& storage_;
  Clock& clock_;
  const double cores_;
  const std::string version_;
  const std::string instance_;
  boost::asio::thread_pool timer_thread_{1};
  boost::asio::thread_pool threads_{4};  // for work that waits
  NatsConnection connection_;
  NatsConnection relay_connection_;
  Lease lease_;
  ClusterStreams streams_;
  Bucket node_bucket_;
  Bucket spare_bucket_;  // for renewals while no server leads `node_bucket_`
  NodeTable nodes_;
  SessionLocator locator_;
  SavedStore saved_;
  ClusterStates saved_states_;
  ClusterScenes saved_scenes_;
  const std::unique_ptr<ClusterTokens> tokens_;  // null: there is no key
  ClusterHost* host_ = nullptr;
  std::atomic<bool> leaving_ = false;
  std::atomic<bool> stopped_ = false;
  std::atomic<bool> draining_ = false;
  std::atomic<bool> checking_ = false;
  std::atomic<bool> needs_refresh_ = false;
  std::atomic<bool> renewing_ = false;
  std::atomic<bool> is_renewed_ = true;           // false: the last renewal failed
  std::atomic<bool> has_name_ = true;             // false: another process has the node's name
  std::atomic<std::uint64_t> name_revision_ = 0;  // of the node's entry
  std::atomic<double> load_ = 0;                  // used cores
  std::atomic<std::chrono::milliseconds> renewal_ = Lease::kLeastRenewal;  // interval

  mutable std::mutex mutex_;  // guards the members below
  std::map<std::uint64_t, Hosted> hosted_;
  // Sessions that are being created, taken, moved or ended.
  std::multiset<std::uint64_t> reserved_;
  std::map<std::uint64_t, Move> moves_;
  std::map<std::uint64_t, Time> failed_;  // times at which a take-over failed
  std::map<std::uint64_t, Time> orphans_;
  bool asks_for_replays_ = false;
  std::vector<std::function<void()>> wait_for_replays_;  // for the next answers

  // Used by the timer's thread only.
  Time last_renewal_{};
  Time last_refresh_{};
  Time last_look_{};                          // at the node's own and released sessions
  std::map<std::string, Time> silent_looks_;  // by silent node: last look at its sessions
  Time measured_at_{};
  double measured_seconds_ = 0;

  const std::unique_ptr<Timer> timer_;
  std::vector<std::unique_ptr<NatsConnection::Subscription>> subscriptions_;
};

}  // namespace vat
