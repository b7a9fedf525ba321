#include "tests/bench/speed/peers.h"

namespace vat::bench {

namespace {

constexpr PeerFigure kPeers[] = {
    {"peer-dam-break-10k-incompressible", 4, 3.3, 4.9e-4, "DFSPH, volume maps"},
    {"peer-dam-break-10k-incompressible", 1, 10.2, 4.9e-4, "DFSPH, volume maps"},
    {"peer-dam-break-30k-incompressible", 4, 23.5, 4.5e-4, "DFSPH, wall particles"},
    {"peer-dam-break-30k-incompressible", 1, 51, 5.0e-4, "DFSPH, volume maps"},
    {"peer-dam-break-97k-incompressible", 4, 95, 4.7e-4, "DFSPH, wall particles"},
    {"peer-dam-break-97k-incompressible", 1, 257, 5.3e-4, "DFSPH, volume maps"},
    {"peer-dam-break-10k-tait", 4, 16.5, 4.6e-3, "WCSPH, wall particles"},
    {"peer-dam-break-10k-tait", 1, 61, 4.6e-3, "WCSPH, wall particles"},
    {"peer-dam-break-30k-tait", 4, 54, 4.6e-3, "WCSPH, wall particles"},
    {"peer-dam-break-30k-tait", 1, 168, 4.6e-3, "WCSPH, wall particles"},
    {"peer-dam-break-97k-tait", 4, 213, 6.1e-3, "WCSPH, wall particles"},
};

}  // namespace

const PeerFigure* find_peer(const SpeedRow& row) {
  for (const PeerFigure& peer : kPeers) {
    if (peer.name == row.name && peer.threads == row.threads) return &peer;
  }
  return nullptr;
}

Table peer_table(const std::vector<SpeedRow>& rows) {
  Table table{
      {"case", "particles", "threads", "wall s per simulated s", "least", "density error [%]",
       "peer's solver", "peer's wall s per simulated s", "peer's density error [%]", "peer / here"},
      {}};
  for (const SpeedRow& row : rows) {
    const PeerFigure* peer = find_peer(row);
    if (peer == nullptr) continue;
    table.rows.push_back({row.name, std::uint64_t{row.particles}, std::uint64_t{row.threads},
                          row.wall_per_simulated(), row.seconds.front() / row.simulated,
                          100 * row.flow.density_error, peer->solver, peer->wall_per_simulated,
                          100 * peer->density_error,
                          peer->wall_per_simulated / row.wall_per_simulated()});
  }
  return table;
}

}  // namespace vat::bench
