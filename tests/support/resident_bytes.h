#pragma once

#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <string>

namespace vat::test {

/// What of a process is in memory. Throws std::runtime_error where there is none of this number.
inline double resident_bytes(const std::string& process = "self") {
  std::ifstream file("/proc/" + process + "/statm");
  double size = 0;
  double resident = 0;
  if (!(file >> size >> resident)) throw std::runtime_error("there is no process " + process);
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace vat::test
