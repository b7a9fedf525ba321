#include "tests/bench/speed/machine.h"

#include <malloc.h>

#include <cstdio>
#include <fstream>
#include <thread>

namespace vat::bench {

namespace {

/// Returns the first line of a command's output; empty if it cannot be run.
std::string first_line_of(const char* command) {
  std::FILE* pipe = popen(command, "r");  // NOLINT(cert-env33-c): a constant, no input
  if (pipe == nullptr) return "";
  char buffer[256] = "";
  std::string line = std::fgets(buffer, sizeof buffer, pipe) != nullptr ? buffer : "";
  if (pclose(pipe) != 0) return "";
  while (!line.empty() && line.back() == '\n') line.pop_back();
  return line;
}

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t text = line.find(": ");
    if (text != std::string::npos) return line.substr(text + 2);
  }
  return "";
}

}  // namespace

Machine this_machine() {
  return {first_line_of("git -C '" VAT_SOURCE_DIR
                        "' describe --always --dirty --abbrev=12 --exclude '*' 2>/dev/null"),
          cpu_model(), std::thread::hardware_concurrency()};
}

std::size_t heap_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace vat::bench
