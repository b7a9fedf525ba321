#include "tests/bench/cluster/relayed_service.h"

namespace vat::bench {

RelayedService::RelayedService(const std::string& program, const std::filesystem::path& folder,
                               const std::string& scene, std::size_t clients) {
  const std::string most = std::to_string(clients + 100);
  for (const char* const name : {"owner", "relay1", "relay2"}) {  // the first creates the session
    nodes_.push_back(
        std::make_unique<Served>(program, std::vector<std::string>{"--cluster",
                                                                   nats_.urls().front(),
                                                                   "--node",
                                                                   name,
                                                                   "--public-url",
                                                                   "ws://127.0.0.1/ws",
                                                                   "--route",
                                                                   "relay",
                                                                   "--data",
                                                                   folder / name,
                                                                   "--scene",
                                                                   scene,
                                                                   "--log-level",
                                                                   "error",
                                                                   "--max-connections",
                                                                   most,
                                                                   "--max-connections-per-address",
                                                                   most,
                                                                   "--max-clients",
                                                                   most}));
  }
}

std::array<double, 3> RelayedService::processor_seconds() const {
  return {nodes_[0]->processor_seconds(),
          nodes_[1]->processor_seconds() + nodes_[2]->processor_seconds(),
          processor_seconds_of(nats_.process(0))};
}

}  // namespace vat::bench
