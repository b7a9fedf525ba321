#include "tests/bench/stability/stability.h"

#include <chrono>
#include <iostream>
#include <memory>
#include <utility>

#include "server/cli/common/command.h"
#include "tests/bench/report/plot.h"
#include "tests/bench/stability/stability_parts.h"

namespace vat::bench {
namespace {

using Part = Result<StabilityCount> (*)(const Options&);
constexpr std::pair<const char*, Part> kParts[] = {{"adversarial", run_adversarial_part},
                                                   {"random", run_random_part},
                                                   {"vats", run_vat_part},
                                                   {"conservation", run_conservation_part},
                                                   {"long-runs", run_long_part},
                                                   {"step-maps", run_map_part}};

Table counts_table(const std::vector<StabilityCount>& counts) {
  Table table{{"part", "scenes", "not finite", "aborts", "outside", "guard events", "retries",
               "wall stops", "stopped", "refused", "faults", "seconds"},
              {}};
  for (const StabilityCount& count : counts) {
    table.rows.push_back({count.part, count.scenes, count.non_finite, count.aborts, count.outside,
                          count.events, count.retries, count.wall_stops, count.stopped,
                          count.refused, count.faults, count.seconds});
  }
  return table;
}

Result<StabilityCount> run_timed(const std::string& name, Part part, const Options& options) {
  std::cout << name << " ..." << std::endl;
  const auto start = std::chrono::steady_clock::now();
  Result<StabilityCount> count = part(options);
  if (!count) return count;
  count.value().part = name;
  count.value().seconds =
      std::chrono::duration<Real>(std::chrono::steady_clock::now() - start).count();
  return count;
}

int stability(const Options& options) {
  std::vector<std::string> names;
  for (const auto& [name, part] : kParts) names.emplace_back(name);
  if (options.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.cases, names);
  if (!chosen) return fail("stability", chosen.errors());
  if (const Status found = find_gnuplot(); !found) return fail("stability", found.errors());
  std::vector<StabilityCount> counts;
  std::uint64_t faults = 0;
  for (const std::size_t index : chosen.value()) {
    const Result<StabilityCount> count = run_timed(names[index], kParts[index].second, options);
    if (!count) return fail(options.output, count.errors());
    faults += count.value().faults;
    counts.push_back(count.value());
  }
  const Table table = counts_table(counts);
  const Status written = write_table(table, options.output, "stability", "# Stability");
  if (!written) return fail(options.output, written.errors());
  std::cout << '\n' << to_markdown(table) << "\nwritten to " << options.output << '\n';
  return faults == 0 ? kExitOk : kExitFailed;
}

}  // namespace

void print_fault(const std::string& name, const std::string& what) {
  std::cout << "  FAULT " << name << ": " << what << std::endl;
}

void add_stability_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "stability", "Adversarial and random scenes, long runs and maps of the largest stable step");
  const auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->footer("Exit codes: 0 success, 1 a result exceeds its bound, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = stability(*options); });
}

}  // namespace vat::bench
