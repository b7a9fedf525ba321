#pragma once

#include <cstddef>

namespace vat::bench {

/// Resources of a process.
struct ProcessFigures {
  double resident = 0;  ///< [bytes]
  std::size_t files = 0;
  std::size_t threads = 0;
};

/// Reads the resources. Throws std::runtime_error if the process has ended.
ProcessFigures process_figures(int process);

}  // namespace vat::bench
