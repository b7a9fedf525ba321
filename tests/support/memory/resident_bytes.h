#pragma once

#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <string>

namespace vat::test {

/// Returns the resident memory of a process. Throws std::runtime_error if there is no such process.
inline double resident_bytes(const std::string& process = "self") {
  std::ifstream file("/proc/" + process + "/statm");
  double size = 0;
  double resident = 0;
  if (!(file >> size >> resident)) throw std::runtime_error("there is no process " + process);
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

}  // namespace vat::test
