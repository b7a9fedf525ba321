#pragma once

#include <string>
#include <vector>

#include "tests/bench/report/table.h"
#include "tests/validation/case.h"

namespace vat::bench {

/// Returns the condition of a row, such as "2.5 +- 0.01" or "<= 1e-12".
std::string tolerance_text(const validation::Row& row);

/// Returns the used fraction of the tolerance; 1 is all of it. Not a number if the row has no
/// condition or no tolerance.
Real share_of_tolerance(const validation::Row& row);

/// Returns one row for each row of the outcomes, and one for each case that ended early.
Table validation_table(const std::vector<validation::Outcome>& outcomes);

}  // namespace vat::bench
