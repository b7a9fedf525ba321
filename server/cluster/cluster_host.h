#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "server/storage/session_store.h"

namespace vat {

/// Runs the sessions that a node of a cluster owns. Threads of the node call the functions, which
/// must not wait for the node.
class ClusterHost {
 public:
  virtual ~ClusterHost() = default;
  /// Starts a session that the node has taken. The data folder contains it.
  virtual void start_taken(const StoredSession& session) = 0;
  /// Ends a session that another node owns, and removes it from the data folder. Clients are told
  /// the URL, which is empty if it is unknown. Calls `done` after the removal: a session that the
  /// node takes again earlier would be removed too.
  virtual void end_lost(std::uint64_t session, const std::string& url,
                        std::function<void()> done) = 0;
  /// Stops a session, stores its state in its replica, and then calls `done`. Returns false if the
  /// session does not run.
  virtual bool stop_for_move(std::uint64_t session, std::function<void()> done) = 0;
  /// Creates a session at the request of another node. Calls `answer` with a JSON text.
  virtual void create_for(const std::string& request,
                          std::function<void(const std::string&)> answer) = 0;
  /// Returns the numbers and names of the replays, which stay on their node.
  virtual std::map<std::uint64_t, std::string> replays() const { return {}; }
  /// Returns JSON texts that describe the running sessions and replays for the admins of all nodes.
  virtual std::map<std::uint64_t, std::string> describe_sessions() const { return {}; }
  /// Called often, and after each change of the cluster's sessions.
  virtual void cluster_changed() = 0;
};

}  // namespace vat
