#pragma once

#include <string>

#include "tests/bench/faults/fault_control.h"

namespace vat::bench {

/// File with a FaultControl that processes share. Throws std::runtime_error if the file cannot be
/// created.
class SharedControl {
 public:
  explicit SharedControl(const std::string& file);
  ~SharedControl();
  SharedControl(const SharedControl&) = delete;
  SharedControl& operator=(const SharedControl&) = delete;

  FaultControl& operator*() { return *control_; }
  FaultControl* operator->() { return control_; }

 private:
  FaultControl* control_ = nullptr;
};

}  // namespace vat::bench
