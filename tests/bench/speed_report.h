#pragma once

#include <ostream>
#include <string>

#include "tests/bench/speed_measure.h"

namespace vat::bench {

/// Columns for a terminal.
void print_speed_header(std::ostream& out);
void print_speed_row(std::ostream& out, const SpeedRow& row);

/// The same as CSV; times in milliseconds.
std::string speed_csv_header();
std::string speed_csv_row(const SpeedRow& row);

}  // namespace vat::bench
