#include "tests/bench/faults/shared_control.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <new>
#include <stdexcept>

namespace vat::bench {

SharedControl::SharedControl(const std::string& file) {
  const int opened = open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  void* memory = MAP_FAILED;
  if (opened >= 0 && ftruncate(opened, sizeof(FaultControl)) == 0) {
    memory = mmap(nullptr, sizeof(FaultControl), PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
  }
  if (opened >= 0) close(opened);
  if (memory == MAP_FAILED) throw std::runtime_error("cannot create " + file);
  control_ = new (memory) FaultControl;
}

SharedControl::~SharedControl() {
  munmap(control_, sizeof(FaultControl));
}

}  // namespace vat::bench
