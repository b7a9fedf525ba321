#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace vat::bench {

/// Nodes of a cluster whose sessions compute nothing.
struct SimulatedNodesSettings {
  std::vector<std::string> servers;  ///< URLs of the NATS servers
  std::filesystem::path folder;      ///< of the nodes' data
  std::size_t first = 0;             ///< number of the first node
  std::size_t count = 0;             ///< of nodes
  std::size_t sessions = 0;          ///< of each node
  double slow_motion = 1;            ///< factor by which the nodes' clock is slower
};

/// Events of the nodes of a process since its start.
struct SimulatedNodesCounts {
  std::uint64_t taken = 0;   ///< sessions of other nodes
  std::uint64_t lost = 0;    ///< sessions that other nodes have taken
  std::uint64_t lapses = 0;  ///< ends of valid leases
};

/// A process with several nodes. It must be started while this program has one thread.
class SimulatedNodes {
 public:
  /// Starts the process. Throws std::runtime_error.
  explicit SimulatedNodes(const SimulatedNodesSettings& settings);
  ~SimulatedNodes();
  SimulatedNodes(const SimulatedNodes&) = delete;
  SimulatedNodes& operator=(const SimulatedNodes&) = delete;

  /// Waits until all nodes have entered the cluster.
  void wait_ready();
  /// Creates the sessions.
  void create_sessions();
  /// Returns the names of the nodes.
  const std::vector<std::string>& names() const { return names_; }
  SimulatedNodesCounts counts();
  /// Sends SIGKILL, and waits for the end.
  void kill();
  int process() const { return process_; }

 private:
  void ask(char command);
  void read(void* data, std::size_t size);

  std::vector<std::string> names_;
  int process_ = -1;  ///< -1: it has ended
  int to_ = -1;
  int from_ = -1;
};

}  // namespace vat::bench
