#include "tests/bench/validate/validate_table.h"
#include "tests/bench/report/table.h"

#include <cmath>
#include <limits>

namespace vat::bench {

using validation::Outcome;
using validation::Row;
using validation::Tolerance;

std::string tolerance_text(const Row& row) {
  const std::string reference = short_text(row.reference);
  const std::string tolerance = short_text(row.tolerance.value);
  switch (row.tolerance.kind) {
    case Tolerance::Kind::absolute:
      return reference + " +- " + tolerance;
    case Tolerance::Kind::relative:
      return reference + " (1 +- " + tolerance + ")";
    case Tolerance::Kind::at_most:
      return "<= " + reference;
    case Tolerance::Kind::at_least:
      return ">= " + reference;
    case Tolerance::Kind::reported:
      return "reported: " + reference;
  }
  return {};
}

Real share_of_tolerance(const Row& row) {
  const Real difference = std::abs(row.measured - row.reference);
  switch (row.tolerance.kind) {
    case Tolerance::Kind::absolute:
      return difference / row.tolerance.value;
    case Tolerance::Kind::relative:
      return difference / (row.tolerance.value * std::abs(row.reference));
    case Tolerance::Kind::at_most:
      return row.measured / row.reference;
    case Tolerance::Kind::at_least:
      return row.reference / row.measured;
    case Tolerance::Kind::reported:
      break;
  }
  return std::numeric_limits<Real>::quiet_NaN();
}

Table validation_table(const std::vector<Outcome>& outcomes) {
  Table table{{"case", "metric", "reference", "measured", "must be", "share of tolerance",
               "tolerance from", "passed", "seconds", "state hash"},
              {}};
  for (const Outcome& outcome : outcomes) {
    for (const Row& row : outcome.rows) {
      const bool judged = row.tolerance.kind != Tolerance::Kind::reported;
      table.rows.push_back({outcome.name, row.metric, row.reference, row.measured,
                            tolerance_text(row), share_of_tolerance(row), row.tolerance.source,
                            judged ? Cell(row.passed()) : Cell(kAbsent), row.seconds,
                            hash_text(row.state_hash)});
    }
    if (!outcome.error) continue;
    table.rows.push_back({outcome.name, "ended early: " + *outcome.error, kAbsent, kAbsent,
                          std::string(), kAbsent, std::string(), false, kAbsent, std::string()});
  }
  return table;
}

}  // namespace vat::bench
