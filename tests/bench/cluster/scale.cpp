#include "tests/bench/cluster/scale.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/cli/common/command.h"
#include "server/cluster/session_locator.h"
#include "tests/bench/cluster/simulated_nodes.h"
#include "tests/bench/fanout/served.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"
#include "tests/cluster/nats_servers.h"

namespace vat::bench {
namespace {

using ScaleClock = std::chrono::steady_clock;

struct ScaleOptions {
  std::size_t processes = 10;
  std::size_t nodes = 20;
  std::size_t sessions = 50;
  double seconds = 10;
  double slow_motion = 1;
  std::string output = VAT_SOURCE_DIR "/build/bench/scale";
};

constexpr double kMaxScaleTakeOver = 10;  // [s], of all sessions
constexpr std::size_t kNatsServers = 3;
constexpr double kScalePatience = 60;   // [s]
constexpr double kScaleSettling = 10;   // [s]
constexpr double kScaleInterval = 0.1;  // [s] between looks at the directory

double scale_seconds_since(ScaleClock::time_point begin) {
  return std::chrono::duration<double>(ScaleClock::now() - begin).count();
}

/// Follows the directory, and notes the times of changes of owners.
class ScaleObserver {
 public:
  explicit ScaleObserver(const std::vector<std::string>& servers)
      : connection_({servers, "observer", {}, {}, {}, {}}), locator_(connection_) {
    locator_.watch([this](const LocatedSession& session) {
      const std::lock_guard lock(mutex_);
      const auto [known, is_new] = epochs_.try_emplace(session.number, session.epoch);
      if (is_new || session.epoch <= known->second) return;
      known->second = session.epoch;
      times_.try_emplace(session.number, ScaleClock::now());
    });
    connection_.flush(std::chrono::seconds(5));
    locator_.refresh();
  }
  /// Returns the numbers of the sessions that these nodes own.
  std::set<std::uint64_t> sessions_of(const std::vector<std::string>& nodes) const {
    std::set<std::uint64_t> numbers;
    for (const std::string& node : nodes) {
      for (const LocatedSession& session : locator_.sessions_of(node)) {
        numbers.insert(session.number);
      }
    }
    return numbers;
  }
  /// Returns the times of the first changes of owners, by session.
  std::map<std::uint64_t, ScaleClock::time_point> times() const {
    const std::lock_guard lock(mutex_);
    return times_;
  }

 private:
  NatsConnection connection_;
  SessionLocator locator_;
  mutable std::mutex mutex_;                       // guards the members below
  std::map<std::uint64_t, std::uint64_t> epochs_;  // by session
  std::map<std::uint64_t, ScaleClock::time_point> times_;
};

/// Bytes that a process has written to sockets and files.
double written_bytes_of(int process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/io");
  std::string name;
  double value = 0;
  while (file >> name >> value) {
    if (name == "wchar:") return value;
  }
  throw std::runtime_error("the system does not count the bytes of process " +
                           std::to_string(process));
}

/// The cluster, its directory, and the costs of its parts.
class ScaleCluster {
 public:
  explicit ScaleCluster(const ScaleOptions& options) {
    const std::filesystem::path folder = std::filesystem::absolute(options.output) / "data";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    for (std::size_t i = 0; i < options.processes; ++i) {
      processes_.push_back(std::make_unique<SimulatedNodes>(
          SimulatedNodesSettings{nats_.urls(), folder, i * options.nodes, options.nodes,
                                 options.sessions, options.slow_motion}));
      processes_.back()->wait_ready();
    }
    for (const auto& process : processes_) process->create_sessions();
  }
  std::vector<std::string> servers() const { return nats_.urls(); }
  SimulatedNodes& process(std::size_t index) { return *processes_.at(index); }
  /// Returns the events of the nodes outside the last process.
  SimulatedNodesCounts counts_of_others() const {
    SimulatedNodesCounts sum;
    for (std::size_t i = 0; i + 1 < processes_.size(); ++i) {
      const SimulatedNodesCounts counts = processes_[i]->counts();
      sum.taken += counts.taken;
      sum.lost += counts.lost;
      sum.lapses += counts.lapses;
    }
    return sum;
  }
  /// Returns the processor time of all nodes [s].
  double node_seconds() const {
    double seconds = 0;
    for (const auto& process : processes_) seconds += processor_seconds_of(process->process());
    return seconds;
  }
  /// Returns the processor time [s] and the written bytes of the NATS servers.
  std::pair<double, double> nats_costs() const {
    double seconds = 0;
    double bytes = 0;
    for (std::size_t i = 0; i < nats_.size(); ++i) {
      seconds += processor_seconds_of(nats_.process(i));
      bytes += written_bytes_of(nats_.process(i));
    }
    return {seconds, bytes};
  }

 private:
  test::NatsServers nats_{kNatsServers};
  std::vector<std::unique_ptr<SimulatedNodes>> processes_;
};

struct ScaleResult {
  double node_cores = 0;  ///< of one node at rest
  double nats_cores = 0;  ///< of all NATS servers at rest
  double nats_bytes = 0;  ///< written per second by all NATS servers at rest
  std::vector<double> take_overs;
  std::size_t orphans = 0;   ///< sessions of the killed nodes
  std::size_t affected = 0;  ///< other sessions with a new owner
  SimulatedNodesCounts counts;
};

ScaleResult measure_scale(const ScaleOptions& options) {
  const auto sleep = [&](double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds * options.slow_motion));
  };
  std::cout << "starting " << options.processes * options.nodes << " nodes ..." << std::endl;
  const auto start = ScaleClock::now();
  ScaleCluster cluster(options);
  std::cout << "nodes and sessions after " << scale_seconds_since(start) << " s" << std::endl;
  sleep(kScaleSettling);

  ScaleResult result;
  const auto begin = ScaleClock::now();
  const double nodes_before = cluster.node_seconds();
  const auto nats_before = cluster.nats_costs();
  sleep(options.seconds);
  const double time = scale_seconds_since(begin) / options.slow_motion;
  const auto count = static_cast<double>(options.processes * options.nodes);
  result.node_cores = (cluster.node_seconds() - nodes_before) / time / count;
  const auto nats_after = cluster.nats_costs();
  result.nats_cores = (nats_after.first - nats_before.first) / time;
  result.nats_bytes = (nats_after.second - nats_before.second) / time;

  const SimulatedNodesCounts counts_before = cluster.counts_of_others();
  ScaleObserver observer(cluster.servers());
  const std::set<std::uint64_t> orphans =
      observer.sessions_of(cluster.process(options.processes - 1).names());
  result.orphans = orphans.size();
  const auto kill = ScaleClock::now();
  cluster.process(options.processes - 1).kill();
  while (observer.times().size() < result.orphans &&
         scale_seconds_since(kill) < kScalePatience * options.slow_motion) {
    sleep(kScaleInterval);
  }
  sleep(kScaleSettling);
  for (const auto& [session, changed] : observer.times()) {
    if (!orphans.contains(session)) {
      ++result.affected;
    } else {
      result.take_overs.push_back(std::chrono::duration<double>(changed - kill).count() /
                                  options.slow_motion);
    }
  }
  std::ranges::sort(result.take_overs);
  const SimulatedNodesCounts counts = cluster.counts_of_others();
  result.counts = {counts.taken - counts_before.taken, counts.lost - counts_before.lost,
                   counts.lapses - counts_before.lapses};
  return result;
}

int run_scale(const ScaleOptions& options) {
  try {
    const ScaleResult result = measure_scale(options);
    const auto part_of = [&](double part) {
      if (result.take_overs.size() < result.orphans) return kAbsent;
      return result.take_overs[static_cast<std::size_t>(
          part * static_cast<double>(result.take_overs.size() - 1) + 0.5)];
    };
    const bool passed = part_of(1) <= kMaxScaleTakeOver && result.affected == 0 &&
                        result.counts.lost == 0 && result.counts.lapses == 0;
    const Machine machine = this_machine();
    const Table table{
        {"nodes", "sessions of a node", "killed nodes", "taken sessions", "median take-over [s]",
         "95 % take-over [s]", "longest take-over [s]", "other sessions with a new owner",
         "sessions lost by other nodes", "lapsed leases", "slow motion", "node at rest [cores]",
         "NATS at rest [cores]", "NATS at rest [MB/s]", "passed", "commit", "cpu", "cores"},
        {{std::uint64_t{options.processes * options.nodes}, std::uint64_t{options.sessions},
          std::uint64_t{options.nodes}, result.counts.taken, part_of(0.5), part_of(0.95),
          part_of(1), std::uint64_t{result.affected}, result.counts.lost, result.counts.lapses,
          options.slow_motion, result.node_cores, result.nats_cores, 1e-6 * result.nats_bytes,
          passed, machine.commit, machine.cpu, std::uint64_t{machine.cores}}}};
    std::cout << to_markdown(table);
    if (const Status status = write_table(table, options.output, "scale", "# Scale"); !status) {
      return fail(options.output, status.errors());
    }
    return passed ? kExitOk : kExitFailed;
  } catch (const std::exception& error) {
    std::cerr << "scale: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

void add_scale_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("scale", "The end of many nodes of a large cluster at once");
  const auto options = std::make_shared<ScaleOptions>();
  command->add_option("--processes", options->processes, "Processes with nodes; one is killed")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  command->add_option("--nodes", options->nodes, "Nodes in each process")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->add_option("--sessions", options->sessions, "Sessions of each node")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Measured time at rest [s]")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str();
  command
      ->add_option(
          "--slow-motion", options->slow_motion,
          "Factor by which the clock of the nodes is slower, for machines with too few cores")
      ->check(CLI::Range(1.0, 20.0))
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the nodes' data")
      ->capture_default_str();
  command->footer(
      "Exit codes: 0 the bounds hold, 1 a bound is exceeded or the cluster failed, "
      "2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = run_scale(*options); });
}

}  // namespace vat::bench
