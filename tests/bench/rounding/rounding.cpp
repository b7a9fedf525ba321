#include "tests/bench/rounding/rounding.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "server/cli/common/option_checks.h"
#include "tests/bench/options.h"
#include "tests/bench/report/table.h"
#include "tests/bench/rounding/drift.h"

namespace vat::bench {

namespace {

struct Settings {
  Options common;
  std::optional<DeviceChoice> device;
};

void add_rows(const ConservingScene& one, const std::string& device, std::uint64_t steps,
              const Drift& drift, const Drift& of_cpu, Table& table) {
  const Real bound = drift_bound(one, drift, steps);
  const auto add = [&](const char* quantity, Real Drift::*change) {
    table.rows.push_back({one.name, quantity, device, steps, drift.*change, of_cpu.*change, bound,
                          drift.*change <= bound});
  };
  if (one.is_of_energy) return add("energy", &Drift::energy);
  add("momentum", &Drift::momentum);
  add("angular momentum", &Drift::angular_momentum);
}

int rounding(const Settings& settings) {
  const std::vector<ConservingScene> scenes = conserving_scenes();
  std::vector<std::string> names;
  for (const ConservingScene& one : scenes) names.push_back(one.name);
  if (settings.common.list) {
    print_names(names);
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(settings.common.cases, names);
  if (!chosen) return fail("rounding", chosen.errors());
  Table table{
      {"scene", "quantity", "device", "steps", "change", "change on the CPU", "bound", "passed"},
      {}};
  const std::uint64_t steps = std::uint64_t{kDriftInterval} * (settings.common.quick ? 1 : 1000);
  const std::string device = settings.device ? to_text(*settings.device) : "cpu";
  for (const std::size_t index : chosen.value()) {
    const ConservingScene& one = scenes[index];
    const Result<Drift> of_cpu = measure_drift(one, {}, steps);
    if (!of_cpu) return fail(one.name, of_cpu.errors());
    const Result<Drift> drift =
        settings.device ? measure_drift(one, settings.device, steps) : of_cpu;
    if (!drift) return fail(one.name, drift.errors());
    add_rows(one, device, steps, drift.value(), of_cpu.value(), table);
  }
  std::cout << to_markdown(table);
  if (Status written = write_table(table, settings.common.output, "rounding", "# Rounding errors");
      !written) {
    return fail(settings.common.output, written.errors());
  }
  const bool passed = std::ranges::all_of(
      table.rows, [](const std::vector<Cell>& row) { return std::get<bool>(row.back()); });
  return passed ? kExitOk : kExitFailed;
}

}  // namespace

void add_rounding_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "rounding", "Changes of conserved quantities by rounding errors in a million steps");
  const auto settings = std::make_shared<Settings>();
  add_case_options(*command, settings->common);
  add_device_option(*command, settings->device);
  command->footer("Exit codes: 0 all changes within their bounds, 1 otherwise, 2 wrong usage.");
  command->callback([settings, &exit_code] {
    std::optional<DeviceChoice>& device = settings->device;
    if (device && device->is_auto) device = DeviceChoice{.is_cpu = false};
    if (device && device->is_cpu) device.reset();
    exit_code = rounding(*settings);
  });
}

}  // namespace vat::bench
