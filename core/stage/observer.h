#pragma once

#include <string_view>

namespace vat {

/// Is notified when a stage of the plan, or another part of advance(), starts. The core has no
/// clock: an observer can measure times.
class StageObserver {
 public:
  virtual ~StageObserver() = default;
  /// The preceding stage has ended, and `stage` begins. The name is a literal.
  virtual void stage_begins(std::string_view stage) = 0;
  /// The last stage has ended: advance() returns or throws.
  virtual void stages_end() = 0;
};

}  // namespace vat
