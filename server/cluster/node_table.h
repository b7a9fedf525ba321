#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/support/clock.h"

namespace vat {

/// Node of a cluster, as the node describes itself with each renewal.
struct NodeInfo {
  std::string name;
  std::string instance;         ///< differs after each start
  std::string url;              ///< URL at which clients reach the node
  std::string instruction_set;  ///< best instruction set of the machine
  std::string version;
  double room = 0;                                 ///< unused processor cores
  bool accepts = true;                             ///< false: the node takes no further sessions
  std::map<std::uint64_t, std::string> replays{};  ///< replays on the node: number and name
};

std::string write_node(const NodeInfo& node);
/// Returns the subject of questions to a node.
inline std::string question_subject(const std::string& node) {
  return "vat.node." + node + ".ask";
}
/// Returns whether the machine of the node has this instruction set.
bool has_instructions(const NodeInfo& node, const std::string& instruction_set);
/// Returns nothing if the text is invalid, or describes another node than `name`.
std::optional<NodeInfo> read_node(const std::string& name, const std::string& text);

/// Nodes of a cluster, with the times at which this process received their renewals. Thread-safe.
class NodeTable {
 public:
  explicit NodeTable(const Clock& clock) : clock_(clock), begin_(clock.now()) {}

  /// Notes a renewal with this revision of the node's entry.
  void note(NodeInfo node, std::uint64_t revision);
  /// Notes the replays of a known node before its next renewal.
  void note_replays(const std::string& name, std::map<std::uint64_t, std::string> replays);
  /// Forgets a node that has left.
  void forget(const std::string& name);
  std::optional<NodeInfo> find(const std::string& name) const;
  /// Returns the nodes with a renewal within the last `time`.
  std::vector<NodeInfo> seen_within(SteadyClock::duration time) const;
  bool is_seen_within(const std::string& name, SteadyClock::duration time) const;
  /// Returns the revision of the node's last known renewal; 0: none.
  std::uint64_t revision_of(const std::string& name) const;
  /// Returns the number of other nodes that should take a session before the node `name`: those
  /// with a renewal within the last `time`, which take sessions and satisfy the condition. See
  /// rank_nodes().
  std::size_t count_before(const std::string& name, std::uint64_t session,
                           SteadyClock::duration time,
                           const std::function<bool(const NodeInfo&)>& can_take) const;
  /// Returns how long no renewal of the node has arrived, at most since the start of this process.
  SteadyClock::duration silence_of(const std::string& name) const;

 private:
  struct Seen {
    NodeInfo node;
    SteadyClock::time_point time;
    std::uint64_t revision = 0;
  };
  const Clock& clock_;
  const SteadyClock::time_point begin_;
  mutable std::mutex mutex_;
  std::map<std::string, Seen> nodes_;
};

/// Returns the names in the order in which the nodes should take a session (rendezvous hashing):
/// the order differs from session to session, and the end of a node does not change the order of
/// the others.
std::vector<std::string> rank_nodes(std::uint64_t session, std::vector<std::string> names);

}  // namespace vat
