#include "tests/bench/race/race.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/support/check.h"
#include "server/cli/common/command.h"
#include "tests/bench/options.h"
#include "tests/bench/race/peer_run.h"
#include "tests/bench/report/quantile.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"
#include "tests/bench/speed/measure.h"
#include "tests/bench/speed/scenes.h"

namespace vat::bench {

namespace {

/// A dam break of one size, with the solvers of both programs.
struct RaceCase {
  const char* name;
  int edge;
  PressureSolver solver;
  Real seconds;  ///< [s] simulated
  bool is_long;
};

constexpr RaceCase kRaceCases[] = {
    {"10k-incompressible", 22, PressureSolver::incompressible, 1, false},
    {"30k-incompressible", 31, PressureSolver::incompressible, 0.5, true},
    {"97k-incompressible", 46, PressureSolver::incompressible, 0.25, true},
    {"10k-tait", 22, PressureSolver::tait, 0.5, false},
    {"30k-tait", 31, PressureSolver::tait, 0.25, true},
};

struct RaceOptions {
  Options common;
  std::string program;
  std::vector<std::size_t> threads;
  int rounds = 5;
};

/// Times of both programs [s/s], one element per round.
struct RaceTimes {
  std::vector<Real> peer;
  std::vector<Real> vat;
  SpeedRow row;  ///< of the last round
};

Real median_ratio(const RaceTimes& times) {
  VAT_CHECK(times.peer.size() == times.vat.size());
  std::vector<Real> ratios;
  for (std::size_t i = 0; i < times.vat.size(); ++i) ratios.push_back(times.peer[i] / times.vat[i]);
  return median(std::move(ratios));
}

Result<RaceTimes> run_race(const RaceCase& one, const RaceOptions& options, std::size_t threads) {
  const PeerRun run{options.program, one.edge, one.solver, threads, one.seconds};
  const SpeedSettings settings{.warm_up = 0, .measured = one.seconds, .repetitions = 1};
  const SpeedSetup setup{{threads}, best_instruction_set()};
  const Scene scene = peer_dam_break(one.edge, one.solver);
  // The first run of the peer fills the cache of its walls.
  PeerRun first = run;
  first.seconds = 0.001;
  if (const Result<Real> cached = run_peer(first, options.common.output); !cached) {
    return cached.errors();
  }
  RaceTimes times;
  for (int round = 0; round < options.rounds; ++round) {
    const Result<Real> peer = run_peer(run, options.common.output);
    if (!peer) return peer.errors();
    Result<std::vector<SpeedRow>> rows = measure(one.name, scene, setup, settings);
    if (!rows) return rows.errors();
    times.row = std::move(rows.value().front());
    times.peer.push_back(peer.value());
    times.vat.push_back(times.row.wall_per_simulated());
    std::cout << one.name << ", " << threads << " threads: peer " << times.peer.back() << ", vat "
              << times.vat.back() << " s/s\n";
  }
  return times;
}

int race(RaceOptions options) {
  std::vector<std::string> names;
  for (const RaceCase& one : kRaceCases) names.emplace_back(one.name);
  if (options.common.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.common.cases, names);
  if (!chosen) return fail("race", chosen.errors());
  options.program = std::filesystem::absolute(options.program).string();
  options.common.output = std::filesystem::absolute(options.common.output).string();
  if (options.threads.empty()) options.threads = {1, std::thread::hardware_concurrency()};
  const Machine machine = this_machine();
  Table table{{"case", "particles", "threads", "simulated [s]", "rounds", "vat [s/s]",
               "SPlisHSPlasH [s/s]", "SPlisHSPlasH / vat", "density error of vat [%]",
               "solver of SPlisHSPlasH", "instruction set", "commit", "cpu", "cores"},
              {}};
  for (const std::size_t index : chosen.value()) {
    const RaceCase& one = kRaceCases[index];
    if (one.is_long && options.common.quick && options.common.cases.empty()) continue;
    for (const std::size_t threads : options.threads) {
      const Result<RaceTimes> times = run_race(one, options, threads);
      if (!times) return fail("race", times.errors());
      const RaceTimes& result = times.value();
      table.rows.push_back({one.name, std::uint64_t{result.row.particles}, std::uint64_t{threads},
                            one.seconds, static_cast<std::uint64_t>(options.rounds),
                            median(result.vat), median(result.peer), median_ratio(result),
                            100 * result.row.flow.density_error, peer_solver(one.solver),
                            to_string(result.row.instructions), machine.commit, machine.cpu,
                            std::uint64_t{machine.cores}});
    }
  }
  std::cout << '\n' << to_markdown(table);
  const Status written = write_table(table, options.common.output, "race", "# Race");
  if (!written) return fail(options.common.output, written.errors());
  std::cout << "\nwritten to " << options.common.output << '\n';
  return kExitOk;
}

}  // namespace

void add_race_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("race", "Time of SPlisHSPlasH and of vat on one dam break, alternately");
  const auto options = std::make_shared<RaceOptions>();
  add_case_options(*command, options->common);
  command->add_option("--program", options->program, "The program SPHSimulator of SPlisHSPlasH")
      ->check(CLI::ExistingFile);
  command
      ->add_option("--threads", options->threads,
                   "Number of threads; may be given again. Default: 1 and all")
      ->check(thread_count_range())
      ->take_all()
      ->expected(1);
  command->add_option("--rounds", options->rounds, "Runs of each program")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  command->footer("Exit codes: 0 success, 1 a run failed, 2 wrong usage.");
  command->callback([options, &exit_code] {
    if (options->program.empty() && !options->common.list) throw CLI::RequiredError("--program");
    exit_code = race(*options);
  });
}

}  // namespace vat::bench
