#include "tests/bench/race/peer_run.h"

#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <vector>

#include "core/support/check.h"
#include "tests/bench/report/run_program.h"
#include "tests/bench/report/table.h"

namespace vat::bench {

namespace {

namespace fs = std::filesystem;

// Numbers of the peer's methods.
constexpr int kWcsph = 0;
constexpr int kDfsph = 4;
constexpr int kWallParticles = 0;
constexpr int kVolumeMaps = 2;

constexpr const char* kLog = "peer.log";

/// Returns the last number of a line that may end in a unit.
std::optional<Real> last_number(const std::string& line) {
  std::istringstream words(line);
  std::optional<Real> number;
  for (std::string word; words >> word;) {
    std::istringstream text(word);
    Real value = 0;
    if (text >> value && text.eof()) number = value;
  }
  return number;
}

}  // namespace

const char* peer_solver(PressureSolver solver) {
  return solver == PressureSolver::incompressible ? "DFSPH, volume maps" : "WCSPH, wall particles";
}

Json peer_scene(const PeerRun& run) {
  VAT_CHECK(run.edge > 0);
  const bool is_incompressible = run.solver == PressureSolver::incompressible;
  const Real spacing = 1.0 / run.edge;
  const Real half = (run.edge + 1) * spacing / 2;
  Json numerics = {{"particleRadius", spacing / 2},
                   {"simulationMethod", is_incompressible ? kDfsph : kWcsph},
                   {"boundaryHandlingMethod", is_incompressible ? kVolumeMaps : kWallParticles},
                   {"gravitation", {0, -9.81, 0}},
                   {"timeStepSize", 0.001},
                   {"cflMethod", 1},
                   {"cflFactor", 1},
                   {"cflMaxTimeStepSize", is_incompressible ? 0.005 : 0.4 * spacing / 18.7},
                   {"DFSPH",
                    {{"minIterations", 2},
                     {"maxIterations", 100},
                     {"maxError", 0.05},
                     {"maxIterationsV", 100},
                     {"maxErrorV", 0.1},
                     {"enableDivergenceSolver", true}}},
                   {"WCSPH", {{"stiffness", 50000}, {"exponent", 7}}}};
  const fs::path box =
      fs::absolute(run.program).parent_path() / ".." / "data" / "models" / "UnitBox.obj";
  Json walls = {{"geometryFile", fs::weakly_canonical(box).string()},
                {"translation", {0, 1.5, 0}},
                {"rotationAxis", {1, 0, 0}},
                {"rotationAngle", 0},
                {"scale", {4, 3, 1.5}},
                {"color", {0.1, 0.4, 0.6, 1.0}},
                {"isDynamic", false},
                {"isWall", true},
                {"mapInvert", true},
                {"mapThickness", 0.0},
                {"mapResolution", {2 * run.edge, 3 * run.edge / 2, 78 * run.edge / 100}}};
  const Json viscosity = {{"viscosity", 0.01}};
  return {{"Configuration", std::move(numerics)},
          {"Materials", Json::array({{{"id", "Fluid"},
                                      {"density0", 1000},
                                      {"viscosityMethod", 1},
                                      {"Standard viscosity", viscosity}}})},
          {"RigidBodies", Json::array({std::move(walls)})},
          {"FluidBlocks", Json::array({{{"denseMode", 0},
                                        {"start", {-2.0, 0.0, -half}},
                                        {"end", {-2.0 + 2 * half, 2 * half, half}}}})}};
}

Result<Real> run_peer(const PeerRun& run, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{"system", folder.string(), error.message()};
  const fs::path scene = folder / "peer.json";
  if (Status written = write_text(scene, peer_scene(run).dump(1)); !written) {
    return written.errors();
  }
  const Status done = run_program(
      {"env", "OMP_NUM_THREADS=" + std::to_string(run.threads), "OMP_PROC_BIND=true",
       run.program.string(), "--no-gui", "--no-initial-pause", "--stopAt",
       std::to_string(run.seconds), "--output-dir", (folder / "peer").string(), scene.string()},
      folder, kLog, "name the program with --program");
  if (!done) return done.errors();
  std::ifstream log(folder / kLog, std::ios::binary);
  return parse_peer_times({std::istreambuf_iterator<char>(log), {}});
}

Result<Real> parse_peer_times(const std::string& output) {
  std::istringstream lines(output);
  std::optional<Real> milliseconds;
  std::optional<Real> simulated;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("Time sum: SimStep") != std::string::npos) milliseconds = last_number(line);
    if (line.find("Total number: Time step size") != std::string::npos) {
      simulated = last_number(line);
    }
  }
  if (!milliseconds || !simulated || !(*simulated > 0)) {
    return Error{"bad_output", kLog, "does not contain the times of the steps"};
  }
  return *milliseconds / 1000 / *simulated;
}

}  // namespace vat::bench
