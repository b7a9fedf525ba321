#pragma once

namespace vat {

/// While an InterruptWatch exists, SIGINT and SIGTERM are only recorded, so that a run can end
/// cleanly. A second signal ends the program at once. Ignored signals stay ignored. One may exist
/// at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// Returns the number of the received signal; 0: none.
  int signal() const;
};

}  // namespace vat
