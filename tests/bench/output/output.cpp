#include "tests/bench/output/output.h"

#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/simulation/simulation.h"
#include "server/cli/common/command.h"
#include "server/output/frame_writer.h"
#include "tests/bench/options.h"
#include "tests/bench/report/quantile.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"
#include "tests/bench/speed/scenes.h"

namespace vat::bench {
namespace {

namespace fs = std::filesystem;
using std::chrono::steady_clock;
using Milliseconds = std::chrono::duration<double, std::milli>;

constexpr const char* kFormats[] = {".csv", ".npy", ".npz", ".ply", ".pvd", ".glb", ".abc"};

struct OutputCase {
  const char* name;
  int layers;  ///< of the dam break with 2 × layers³ particles
  std::size_t outputs;
};
constexpr OutputCase kOutputCases[] = {
    {"dam-break-1k", 8, 20}, {"dam-break-10k", 17, 10}, {"dam-break-100k", 37, 10}};
constexpr std::uint32_t kStartSteps = 50;  // so that positions are not those of a lattice

template <class Work>
double time_of(const Work& work) {
  const auto begin = steady_clock::now();
  work();
  return Milliseconds(steady_clock::now() - begin).count();
}

void require(const Status& status) {
  if (!status) throw std::runtime_error(status.errors().front().message);
}

/// Costs of one format. Times are in milliseconds per output.
struct OutputCost {
  double write = 0;   ///< median
  double finish = 0;  ///< time of finish() / outputs
  double bytes = 0;   ///< per output
};

double bytes_in(const fs::path& folder) {
  double bytes = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    bytes += static_cast<double>(entry.file_size());
  }
  return bytes;
}

OutputCost measure_format(Simulation& simulation, const std::string& ending, std::size_t outputs,
                          const fs::path& folder) {
  fs::remove_all(folder);
  fs::create_directories(folder);
  auto writer = create_frame_writer((folder / ("run" + ending)).string(), {outputs, false});
  if (!writer) throw std::runtime_error(writer.errors().front().message);
  std::vector<double> times;
  for (std::size_t i = 0; i < outputs; ++i) {
    simulation.advance(1);  // the files differ, and the liquid fields are computed anew
    times.push_back(time_of([&] { require(writer.value()->write(simulation)); }));
  }
  OutputCost cost;
  const auto count = static_cast<double>(outputs);
  cost.finish = time_of([&] { require(writer.value()->finish()); }) / count;
  cost.write = median(std::move(times));
  cost.bytes = bytes_in(folder) / count;
  fs::remove_all(folder);
  return cost;
}

/// Returns the time to compute density and pressure, which .csv and .pvd contain [ms].
double time_of_fields(Simulation& simulation, std::size_t outputs) {
  std::vector<double> times;
  for (std::size_t i = 0; i < outputs; ++i) {
    simulation.advance(1);
    times.push_back(time_of([&] { static_cast<void>(simulation.liquid_fields()); }));
  }
  return median(std::move(times));
}

void add_rows(const OutputCase& measured, const fs::path& folder, Table& table) {
  Result<Simulation> created = Simulation::create(dam_break(measured.layers, PressureSolver::tait));
  if (!created) throw std::runtime_error(created.errors().front().message);
  Simulation& simulation = created.value();
  if (simulation.advance(kStartSteps).failed) throw std::runtime_error("a step failed");
  const Machine machine = this_machine();
  const auto particles = static_cast<double>(simulation.particle_count());
  const double fields = time_of_fields(simulation, measured.outputs);
  for (const std::string ending : kFormats) {
    const OutputCost cost = measure_format(simulation, ending, measured.outputs, folder / "files");
    const bool has_fields = ending == ".csv" || ending == ".pvd";
    table.rows.push_back({measured.name, std::uint64_t{simulation.particle_count()}, ending,
                          std::uint64_t{measured.outputs}, cost.write, cost.finish,
                          has_fields ? fields : 0, cost.bytes / 1e6, cost.bytes / particles,
                          machine.commit, machine.cpu, std::uint64_t{machine.cores}});
  }
}

int measure_outputs(const Options& options) {
  std::vector<std::string> names;
  for (const OutputCase& each : kOutputCases) names.emplace_back(each.name);
  if (options.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.cases, names);
  if (!chosen) return fail("output", chosen.errors());
  Table table{{"case", "particles", "format", "outputs", "write [ms]", "finish [ms]",
               "density and pressure [ms]", "MB per output", "bytes per particle", "commit", "cpu",
               "cores"},
              {}};
  try {
    for (const std::size_t index : chosen.value()) {
      if (options.quick && index > 0 && options.cases.empty()) break;
      add_rows(kOutputCases[index], options.output, table);
    }
  } catch (const std::exception& error) {
    std::cerr << "output: " << error.what() << '\n';
    return kExitFailed;
  }
  std::cout << to_markdown(table);
  const Status written = write_table(table, options.output, "output", "# Output files");
  return written ? kExitOk : fail(options.output, written.errors());
}

}  // namespace

void add_output_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("output", "Size of output files, and the time to write them");
  const auto options = std::make_shared<Options>();
  add_case_options(*command, *options);
  command->footer("Exit codes: 0 measured, 1 a run or a file failed, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = measure_outputs(*options); });
}

}  // namespace vat::bench
