#include "tests/bench/faults/log_causes.h"

#include <algorithm>
#include <sstream>
#include <string_view>

namespace vat::bench {
namespace {

struct KnownLine {
  std::string_view part;
  const char* cause;
};

constexpr KnownLine kKnownLines[] = {
    {"a wrong token, number ", "a client with an invalid token"},
};

}  // namespace

LoggedCauses find_causes(const std::string& log) {
  LoggedCauses causes;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const auto* const known = std::ranges::find_if(kKnownLines, [&](const KnownLine& one) {
      return line.find(one.part) != std::string::npos;
    });
    if (known == std::end(kKnownLines)) {
      causes.unexplained.push_back(line);
    } else {
      ++causes.counts[known->cause];
    }
  }
  return causes;
}

}  // namespace vat::bench
