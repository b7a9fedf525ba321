#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/device_choice.h"
#include "tests/bench/report/table.h"
#include "tests/validation/case.h"

namespace vat::bench {

/// A row of the validation table on a device, and the same row on the CPU.
struct DeviceRow {
  validation::Row on_device;  ///< with the refusal, if the device did not take all steps
  std::optional<validation::Row> on_cpu;  ///< absent with a refusal

  bool is_refused() const { return !on_device.refusal.empty(); }
  bool passed() const { return is_refused() || on_device.passed(); }
};

/// The results of a case on a device.
struct DeviceOutcome {
  std::string name;
  std::vector<DeviceRow> rows;
  std::optional<std::string> error;  ///< reason of an early end

  bool passed() const;
};

/// Runs a case on the device of `settings`, and on the CPU if the device supports a row.
DeviceOutcome run_on_device(const validation::Case& one, const validation::Settings& settings);

/// Returns the difference from the reference, or the measured value if the reference is a bound.
Real error_of(const validation::Row& row);

/// Returns one row for each row of the outcomes, and one for each case that ended early.
Table device_validation_table(const std::vector<DeviceOutcome>& outcomes,
                              const DeviceChoice& device);

}  // namespace vat::bench
