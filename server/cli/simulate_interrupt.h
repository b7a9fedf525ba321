#pragma once

namespace vat {

/// While it lives, SIGINT and SIGTERM are only noted, so that a run can end in order; a second one
/// ends the program at once. A signal that was ignored before stays so. One at a time.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

  /// Number of the signal that came; 0: none.
  int signal() const;
};

}  // namespace vat
