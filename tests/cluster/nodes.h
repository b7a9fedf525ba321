#pragma once

#include "server/script/server_process.h"
#include "tests/cluster/nats_servers.h"
#include "tests/recovery/client.h"

namespace vat::test {

/// Nodes "a", "b", ... of a cluster, each a process `vat serve`, on three NATS servers.
class Nodes {
 public:
  /// Starts `count` nodes. `options` are further options of each node.
  /// `threads` are the numbers of threads of some nodes. The others have two.
  explicit Nodes(std::size_t count, std::vector<std::string> options = {},
                 std::map<std::string, std::size_t> threads = {});

  NatsServers& nats() { return nats_; }
  /// Starts the node again, after its end.
  void start(const std::string& node);
  script::ServerProcess& process(const std::string& node) { return *nodes_.at(node).process; }
  /// Sends SIGSTOP or SIGCONT. After SIGSTOP, waits until the process has stopped.
  void signal(const std::string& node, int signal);
  std::string url(const std::string& node) const;
  /// Returns the names of all nodes except `node`.
  std::vector<std::string> others(const std::string& node) const;

  /// Returns a connection to the node.
  WaitingClient connect(const std::string& node) const;
  /// Returns the name of the node that has the session, as `asked` knows it. Waits until there is
  /// one that differs from `before`.
  std::string owner_of(const std::string& session, const std::string& asked,
                       const std::string& before = "") const;

  /// A client that has joined a session.
  struct Joined {
    WaitingClient client;
    Json result;  ///< of session.join
    std::string node;
  };
  /// Joins a session, starting at a node, and follows the error `moved`.
  Joined join(const std::string& session, const std::string& node,
              const Json& params = Json::object()) const;

 private:
  struct Node {
    std::uint16_t port = 0;
    std::unique_ptr<script::ServerProcess> process;
  };
  std::string node_at(const std::string& url) const;

  TemporaryFolder folder_;
  NatsServers nats_{3};
  const std::vector<std::string> options_;
  const std::map<std::string, std::size_t> threads_;
  std::map<std::string, Node> nodes_;
};

}  // namespace vat::test
