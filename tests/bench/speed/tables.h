#pragma once

#include <ostream>
#include <vector>

#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// Returns all results, a row for each case and number of threads.
Table speed_table(const std::vector<SpeedRow>& rows, const Machine& machine);

/// Returns the time of each stage in the fastest repetition; "rest" is the time outside stages.
Table stage_table(const std::vector<SpeedRow>& rows);

/// Prints the most important columns for a terminal.
void print_speed_header(std::ostream& out);
void print_speed_row(std::ostream& out, const SpeedRow& row);

}  // namespace vat::bench
