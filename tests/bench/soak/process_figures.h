#pragma once

#include <cstddef>

namespace vat::bench {

/// What a process holds of the system.
struct ProcessFigures {
  double resident = 0;  ///< [bytes]
  std::size_t files = 0;
  std::size_t threads = 0;
};

/// Throws std::runtime_error where the process has gone.
ProcessFigures process_figures(int process);

}  // namespace vat::bench
