#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/scene/scene.h"
#include "core/support/result.h"
#include "protocol/json/json_reader.h"

/// Runs of the liquid simulator SPlisHSPlasH on the scene of peer_dam_break().
namespace vat::bench {

/// Parameters of one run.
struct PeerRun {
  std::filesystem::path program;  ///< its SPHSimulator; its models are in ../data/models
  int edge = 22;                  ///< particles along an edge of the cubic metre
  PressureSolver solver = PressureSolver::incompressible;  ///< or tait
  std::size_t threads = 1;
  Real seconds = 1;  ///< [s] simulated
};

/// Returns the names of the peer's solver and wall treatment.
const char* peer_solver(PressureSolver solver);

/// Returns the scene in the peer's format. tests/bench/README.md compares its parameters with
/// vat's.
Json peer_scene(const PeerRun& run);

/// Runs the peer in `folder`. Returns the wall time of its steps per simulated time [s/s]. Fails if
/// the program cannot be started, fails, or does not print its times.
Result<Real> run_peer(const PeerRun& run, const std::filesystem::path& folder);

/// Reads the wall time of the steps per simulated time [s/s] from the program's output.
Result<Real> parse_peer_times(const std::string& output);

}  // namespace vat::bench
