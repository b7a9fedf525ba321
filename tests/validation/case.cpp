#include "tests/validation/case.h"

#include <algorithm>
#include <exception>

namespace vat::validation {

void Sheet::add(std::string metric, Real reference, Real measured, Tolerance tolerance,
                const Run& run) {
  rows_.push_back({std::move(metric), reference, measured, std::move(tolerance), run.state_hash(),
                   run.seconds()});
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
