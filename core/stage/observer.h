#pragma once

#include <string_view>

namespace vat {

/// Told what advance() is at: each stage of the plan, and all that is done besides, by names of the
/// same kind. No clock.
class StageObserver {
 public:
  virtual ~StageObserver() = default;
  /// What was at work before, if anything, has ended. The name is a literal: it lives on.
  virtual void stage_begins(std::string_view stage) = 0;
  /// Nothing is at work any more: advance() returns, or throws.
  virtual void stages_end() = 0;
};

}  // namespace vat
