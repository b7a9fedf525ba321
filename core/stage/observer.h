#pragma once

#include <string_view>

namespace vat {

/// Receives the begin of each stage of the plan, and of the other parts of advance(). The core has
/// no clock: an observer can measure times.
class StageObserver {
 public:
  virtual ~StageObserver() = default;
  /// The preceding stage has ended, and `stage` begins. The name is a literal.
  virtual void stage_begins(std::string_view stage) = 0;
  /// The last stage has ended: advance() returns or throws.
  virtual void stages_end() = 0;
};

}  // namespace vat
