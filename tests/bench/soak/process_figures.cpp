#include "tests/bench/soak/process_figures.h"

#include <filesystem>
#include <iterator>
#include <string>

#include "tests/support/memory/resident_bytes.h"

namespace vat::bench {
namespace {

std::size_t entry_count(const std::string& folder) {
  const std::filesystem::directory_iterator entries(folder);
  return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
}

}  // namespace

ProcessFigures process_figures(int process) {
  const std::string number = std::to_string(process);
  const std::string folder = "/proc/" + number;
  return {test::resident_bytes(number), entry_count(folder + "/fd"), entry_count(folder + "/task")};
}

}  // namespace vat::bench
