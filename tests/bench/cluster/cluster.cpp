#include "tests/bench/cluster/cluster.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <future>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "tests/bench/cluster/cluster_nodes.h"
#include "tests/bench/cluster/cluster_viewer.h"
#include "tests/bench/cluster/following_viewers.h"
#include "tests/bench/report/quantile.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;
using ClusterSeconds = std::chrono::duration<double>;

struct ClusterOptions {
  std::string scene = "sliding-vat-liquid";
  std::size_t kills = 20;
  std::size_t moves = 6;
  std::size_t viewers = 100;
  std::string program = VAT_PROGRAM;
  std::string output = VAT_SOURCE_DIR "/build/bench/cluster";
};

constexpr double kMaxMedianFailOver = 4;  // [s]
constexpr double kMaxFailOver = 5;        // of 95 % [s]
constexpr double kMaxHandOver = 1;        // [s]
constexpr std::chrono::seconds kPlayTime{1};

double seconds_between(steady_clock::time_point begin, steady_clock::time_point end) {
  return ClusterSeconds(end - begin).count();
}

/// Stops and starts each node while viewers watch. Returns the longest pause of each viewer [s].
/// Throws if a viewer loses its participant, or receives no frames after a restart.
std::vector<double> restart_all(ClusterNodes& nodes, std::size_t count) {
  FollowingViewers viewers(nodes, count);
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    nodes.stop(node);
    viewers.wait_for_frames();
    nodes.start(node);
    viewers.wait_for_frames();
  }
  return viewers.take_pauses();
}

int measure_cluster(const ClusterOptions& options) {
  ClusterNodes nodes(options.program, std::filesystem::absolute(options.output) / "data",
                     options.scene);
  ClusterViewer viewer(nodes);
  viewer.join(0);
  std::vector<double> kills;
  std::vector<double> moves;
  for (std::size_t i = 0; i < options.kills; ++i) {
    viewer.play(kPlayTime);
    const std::size_t node = viewer.node();
    nodes.kill(node);
    const auto begin = steady_clock::now();
    viewer.join((node + 1) % nodes.size());
    kills.push_back(seconds_between(begin, viewer.last_frame()));
    std::cout << "kill " << i + 1 << ": frames after " << kills.back() << " s" << std::endl;
    nodes.start(node);
  }
  for (std::size_t i = 0; i < options.moves; ++i) {
    viewer.play(kPlayTime);
    const std::size_t node = viewer.node();
    // The destructor of the future waits, also after an exception.
    const auto stop = std::async(std::launch::async, [&] { nodes.stop(node); });
    const std::size_t next = viewer.wait_for_move();
    const auto begin = viewer.last_frame();
    viewer.join(next);
    moves.push_back(seconds_between(begin, viewer.last_frame()));
    std::cout << "stop " << i + 1 << ": no frames for " << moves.back() << " s" << std::endl;
    stop.wait();
    nodes.start(node);
  }
  const std::vector<double> pauses = restart_all(nodes, options.viewers);
  const bool passed = quantile(kills, 0.5) <= kMaxMedianFailOver &&
                      quantile(kills, 0.95) <= kMaxFailOver && quantile(moves, 1) <= kMaxHandOver;
  const Machine machine = this_machine();
  const Table table{{"scene", "kills", "commands", "median fail-over [s]", "95 % fail-over [s]",
                     "hand-overs", "median hand-over [s]", "longest hand-over [s]",
                     "viewers of the rolling restart", "median of their longest pauses [s]",
                     "longest pause [s]", "passed", "commit", "cpu", "cores"},
                    {{options.scene, std::uint64_t{kills.size()}, std::uint64_t{viewer.commands()},
                      quantile(kills, 0.5), quantile(kills, 0.95), std::uint64_t{moves.size()},
                      quantile(moves, 0.5), quantile(moves, 1), std::uint64_t{options.viewers},
                      quantile(pauses, 0.5), quantile(pauses, 1), passed, machine.commit,
                      machine.cpu, std::uint64_t{machine.cores}}}};
  std::cout << to_markdown(table);
  if (const Status status = write_table(table, options.output, "cluster", "# Cluster"); !status) {
    return fail(options.output, status.errors());
  }
  return passed ? kExitOk : kExitFailed;
}

int run_cluster(const ClusterOptions& options) {
  try {
    return measure_cluster(options);
  } catch (const std::exception& error) {
    std::cerr << "cluster: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

void add_cluster_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("cluster", "Fail-over and hand-over of a session");
  const auto options = std::make_shared<ClusterOptions>();
  command->add_option("--scene", options->scene, "Scene of the session")->capture_default_str();
  command->add_option("--kills", options->kills, "Kills of the session's node")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--moves", options->moves, "Stops of the session's node by SIGTERM")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--viewers", options->viewers, "Viewers of the restart of all nodes")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the nodes' data")
      ->capture_default_str();
  command->footer(
      "Exit codes: 0 the bounds hold, 1 a bound is exceeded or the cluster failed, "
      "2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = run_cluster(*options); });
}

}  // namespace vat::bench
