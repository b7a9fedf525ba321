#pragma once

#include <string_view>

namespace vat {

/// An observer that is notified when a stage of the StepPlan or another part of advance() starts.
/// An observer can measure times; the core has no clock.
class StageObserver {
 public:
  virtual ~StageObserver() = default;
  /// Called when `stage` starts; the preceding stage has ended. `stage` is a string literal.
  virtual void stage_begins(std::string_view stage) = 0;
  /// Called after the last stage, before advance() returns or throws.
  virtual void stages_end() = 0;
};

}  // namespace vat
