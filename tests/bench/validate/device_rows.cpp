#include "tests/bench/validate/device_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/bench/validate/validate_table.h"

namespace vat::bench {

using validation::Case;
using validation::Outcome;
using validation::Row;
using validation::Settings;
using validation::Tolerance;

bool DeviceOutcome::passed() const {
  return !error && !rows.empty() && std::ranges::all_of(rows, &DeviceRow::passed);
}

DeviceOutcome run_on_device(const Case& one, const Settings& settings) {
  Outcome on_device = validation::run_case(one, settings);
  DeviceOutcome outcome{one.name, {}, on_device.error};
  for (Row& row : on_device.rows) outcome.rows.push_back({std::move(row), {}});
  if (std::ranges::all_of(outcome.rows, &DeviceRow::is_refused)) return outcome;
  Settings of_cpu = settings;
  of_cpu.device.reset();
  const Outcome on_cpu = validation::run_case(one, of_cpu);
  if (on_cpu.error) outcome.error = *on_cpu.error;
  for (std::size_t n = 0; n < std::min(outcome.rows.size(), on_cpu.rows.size()); ++n) {
    DeviceRow& row = outcome.rows[n];
    if (row.on_device.metric != on_cpu.rows[n].metric) outcome.error = "the CPU has other rows";
    if (!row.is_refused()) row.on_cpu = on_cpu.rows[n];
  }
  return outcome;
}

Real error_of(const Row& row) {
  const bool is_bound = row.tolerance.kind == Tolerance::Kind::at_most ||
                        row.tolerance.kind == Tolerance::Kind::at_least;
  return is_bound ? row.measured : std::abs(row.measured - row.reference);
}

Table device_validation_table(const std::vector<DeviceOutcome>& outcomes,
                              const DeviceChoice& device) {
  Table table{
      {"case", "metric", "device", "reference", "measured", "must be", "error", "error of the CPU",
       "share of tolerance", "passed", "refused", "seconds", "seconds of the CPU"},
      {}};
  for (const DeviceOutcome& outcome : outcomes) {
    for (const DeviceRow& one : outcome.rows) {
      const Row& row = one.on_device;
      const bool is_judged = one.on_cpu && row.tolerance.kind != Tolerance::Kind::reported;
      table.rows.push_back(
          {outcome.name, row.metric, to_text(device), row.reference,
           one.on_cpu ? row.measured : kAbsent, tolerance_text(row),
           one.on_cpu ? error_of(row) : kAbsent, one.on_cpu ? error_of(*one.on_cpu) : kAbsent,
           one.on_cpu ? share_of_tolerance(row) : kAbsent,
           is_judged ? Cell(row.passed()) : Cell(kAbsent), row.refusal,
           one.on_cpu ? row.seconds : kAbsent, one.on_cpu ? one.on_cpu->seconds : kAbsent});
    }
    if (!outcome.error) continue;
    table.rows.push_back({outcome.name, "ended early: " + *outcome.error, to_text(device), kAbsent,
                          kAbsent, std::string(), kAbsent, kAbsent, kAbsent, false, std::string(),
                          kAbsent, kAbsent});
  }
  return table;
}

}  // namespace vat::bench
