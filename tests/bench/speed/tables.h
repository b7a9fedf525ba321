#pragma once

#include <ostream>
#include <vector>

#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"
#include "tests/bench/speed/measure.h"

namespace vat::bench {

/// All that was measured, a row for each case and number of threads.
Table speed_table(const std::vector<SpeedRow>& rows, const Machine& machine);

/// How long each stage of a step takes, in the fastest repetition; "rest" is what no stage has.
Table stage_table(const std::vector<SpeedRow>& rows);

/// The most telling columns, for a terminal.
void print_speed_header(std::ostream& out);
void print_speed_row(std::ostream& out, const SpeedRow& row);

}  // namespace vat::bench
