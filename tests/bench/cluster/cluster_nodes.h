#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "server/script/server_process.h"
#include "tests/cluster/nats_servers.h"

namespace vat::bench {

/// Three nodes of a cluster on three NATS servers, as processes on this machine.
class ClusterNodes {
 public:
  /// Starts the nodes with one session of a scene of the catalogue. The data is in `folder`.
  ClusterNodes(const std::string& program, const std::filesystem::path& folder,
               const std::string& scene);

  std::size_t size() const { return ports_.size(); }
  std::uint16_t port(std::size_t node) const { return ports_.at(node); }
  /// Returns the node with this URL.
  std::size_t node_at(const std::string& url) const;
  void kill(std::size_t node) { processes_.at(node)->kill(); }
  /// Sends SIGTERM and waits for the end.
  void stop(std::size_t node) { processes_.at(node)->stop(); }
  void start(std::size_t node);

 private:
  std::string url(std::size_t node) const;

  const std::string program_;
  const std::filesystem::path folder_;
  const std::string scene_;
  test::NatsServers nats_{3};
  std::map<std::size_t, std::uint16_t> ports_;
  std::map<std::size_t, std::unique_ptr<script::ServerProcess>> processes_;
};

}  // namespace vat::bench
