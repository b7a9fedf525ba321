#pragma once

#include <CLI/CLI.hpp>

namespace vat {

/// A finite number in [min, max]. CLI::Range lets NaN through.
CLI::Validator real_in(double min, double max);

/// A file name that ends in ".csv".
CLI::Validator csv_file_name();

}  // namespace vat
