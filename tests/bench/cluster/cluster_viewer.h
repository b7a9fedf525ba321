#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "protocol/client/connection/connection.h"
#include "protocol/json/json_reader.h"
#include "tests/bench/cluster/cluster_nodes.h"

namespace vat::bench {

/// A viewer that follows the session "s1" from node to node. Its functions throw
/// std::runtime_error after one minute without success, and std::logic_error if the session has
/// lost its participant.
class ClusterViewer {
 public:
  explicit ClusterViewer(const ClusterNodes& nodes) : nodes_(nodes) {}

  std::size_t node() const { return node_; }
  std::size_t commands() const { return commands_; }
  std::chrono::steady_clock::time_point last_frame() const { return last_frame_; }

  /// Joins at the first node that lets it, beginning with `node`, and waits for a frame.
  void join(std::size_t node);
  /// Sends commands and watches for the time. Returns early if the session moves.
  void play(std::chrono::milliseconds time);
  /// Watches until a message arrives. Joins again if the session moves, or if its node is silent.
  void follow();
  /// Reads until the session moves, and returns the node that it moves to.
  std::size_t wait_for_move();

 private:
  bool try_join(std::size_t& node);
  void call(const std::string& method, const Json& params);
  Json send(const std::string& method, const Json& params);
  /// Reads a message. Acknowledges a frame, and returns a text.
  std::optional<Json> read(std::chrono::steady_clock::time_point deadline);

  const ClusterNodes& nodes_;
  std::unique_ptr<client::Connection> connection_;
  std::size_t node_ = 0;
  std::size_t commands_ = 0;
  std::int64_t id_ = 0;
  std::string resume_;
  std::string moved_to_;
  bool is_moved_ = false;
  std::chrono::steady_clock::time_point last_frame_{};
};

}  // namespace vat::bench
