#include "server/operations/memory_limit.h"

#include <fstream>
#include <string>

namespace vat {

std::size_t process_memory() {
  std::ifstream file("/proc/self/status");  // proc(5)
  std::size_t kibibytes = 0;
  for (std::string line; std::getline(file, line);) {
    const bool is_counted = line.starts_with("VmRSS:") || line.starts_with("VmSwap:");
    if (is_counted) kibibytes += std::stoul(line.substr(line.find(':') + 1));
  }
  return 1024 * kibibytes;
}

}  // namespace vat
