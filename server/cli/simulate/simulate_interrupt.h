#pragma once

namespace vat {

/// Recorder of SIGINT and SIGTERM, so that a run can end cleanly. A second signal ends the program
/// immediately. Ignored signals remain ignored. At most one InterruptWatch may exist at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// Returns the number of the received signal, or 0.
  int signal() const;
};

}  // namespace vat
