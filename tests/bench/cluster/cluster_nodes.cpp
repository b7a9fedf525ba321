#include "tests/bench/cluster/cluster_nodes.h"

#include <stdexcept>
#include <vector>

namespace vat::bench {
namespace {

constexpr std::size_t kNodeCount = 3;

}  // namespace

ClusterNodes::ClusterNodes(const std::string& program, const std::filesystem::path& folder,
                           const std::string& scene)
    : program_(program), folder_(folder), scene_(scene) {
  std::filesystem::remove_all(folder_);
  for (std::size_t node = 0; node < kNodeCount; ++node) {
    ports_[node] = test::free_port();
    start(node);
  }
}

std::string ClusterNodes::url(std::size_t node) const {
  return "ws://127.0.0.1:" + std::to_string(port(node)) + "/ws";
}

std::size_t ClusterNodes::node_at(const std::string& wanted) const {
  for (const auto& [node, port] : ports_) {
    if (url(node) == wanted) return node;
  }
  throw std::runtime_error("no node has the URL " + wanted);
}

void ClusterNodes::start(std::size_t node) {
  std::string servers;
  for (const std::string& one : nats_.urls()) servers += (servers.empty() ? "" : ",") + one;
  const std::string name = "node" + std::to_string(node);
  processes_[node] = nullptr;
  processes_[node] = std::make_unique<script::ServerProcess>(
      program_, std::vector<std::string>{
                    "serve", "--cluster", servers, "--node", name, "--public-url", url(node),
                    "--port", std::to_string(port(node)), "--data", folder_ / name, "--scene",
                    scene_, "--drain-seconds", "5", "--log-level", "error"});
}

}  // namespace vat::bench
