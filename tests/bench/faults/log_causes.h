#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace vat::bench {

/// Warnings and errors of a server's log, by their cause.
struct LoggedCauses {
  std::map<std::string, std::size_t> counts;  ///< lines of each known cause
  std::vector<std::string> unexplained;       ///< all other lines
};

/// Sorts the lines of a log with text format and the level "warn".
LoggedCauses find_causes(const std::string& log);

}  // namespace vat::bench
