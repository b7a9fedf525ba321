#include "tests/validation/case.h"

#include <algorithm>
#include <exception>

namespace vat::validation {

Run Sheet::start(const Scene& scene) {
  if (settings_.device && (has_rows_ || !device_)) {
    device_ = std::make_shared<DeviceUse>(DeviceUse{*settings_.device});
  }
  has_rows_ = false;
  return Run(scene, settings_.runner, device_);
}

void Sheet::add(Row row) {
  if (settings_.device) row.refusal = device_ ? device_->reason() : DeviceUse{}.reason();
  has_rows_ = true;
  rows_.push_back(std::move(row));
}

void Sheet::add(std::string metric, Real reference, Real measured, Tolerance tolerance,
                const Run& run) {
  has_rows_ = true;
  rows_.push_back({std::move(metric), reference, measured, std::move(tolerance), run.state_hash(),
                   run.seconds(), run.device() ? run.device()->reason() : std::string()});
}

bool Outcome::passed() const {
  return !error && !rows.empty() && std::ranges::all_of(rows, &Row::passed);
}

Outcome run_case(const Case& one, const Settings& settings) {
  Sheet sheet(settings);
  std::optional<std::string> error;
  try {
    one.run(sheet);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  return {one.name, sheet.rows(), std::move(error)};
}

}  // namespace vat::validation
