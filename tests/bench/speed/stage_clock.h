#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "core/simulation.h"

namespace vat::bench {

/// Adds up the wall time of each stage; that of a stage within another is not the outer one's.
class StageClock final : public StageObserver {
 public:
  struct Stage {
    std::string name;
    Real seconds = 0;
  };

  void stage_begins(std::string_view stage) override;
  void stage_ends(std::string_view stage) override;

  /// In the order in which they first began.
  const std::vector<Stage>& stages() const { return stages_; }

 private:
  using Clock = std::chrono::steady_clock;
  void charge_running(Clock::time_point now);

  std::vector<Stage> stages_;
  std::vector<std::size_t> running_;  ///< from the outermost
  Clock::time_point since_;           ///< when the innermost began, or went on
};

}  // namespace vat::bench
