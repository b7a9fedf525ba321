#pragma once

#include <string>
#include <vector>

#include "tests/bench/report/table.h"
#include "tests/validation/case.h"

namespace vat::bench {

/// The condition that a row has to meet, such as "2.5 +- 0.01" or "<= 1e-12".
std::string tolerance_text(const validation::Row& row);

/// How much of the tolerance the measured value uses: 1 is all of it. Not a number where nothing is
/// judged, or the tolerance is none at all.
Real share_of_tolerance(const validation::Row& row);

/// One row for each row of the outcomes, and one for a case that ended early.
Table validation_table(const std::vector<validation::Outcome>& outcomes);

}  // namespace vat::bench
