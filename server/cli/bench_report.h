#pragma once

#include <ostream>
#include <string>

#include "server/cli/bench_measure.h"

namespace vat {

/// Columns for a terminal.
void print_bench_header(std::ostream& out);
void print_bench_row(std::ostream& out, const BenchRow& row);

/// The same as CSV; times in milliseconds.
std::string bench_csv_header();
std::string bench_csv_row(const BenchRow& row);

}  // namespace vat
