#pragma once

#include <chrono>
#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "core/simulation.h"

namespace vat {

/// Adds up the wall time of each stage of the step.
class StageProfile final : public StageObserver {
 public:
  void stage_begins(std::string_view stage) override;
  void stage_ends(std::string_view stage) override;

  /// Table of the stages by falling time, with their share of `stepping` (all time spent in steps)
  /// and a row for what no stage accounts for.
  void print(std::ostream& out, std::chrono::duration<double> stepping) const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Stage {
    std::string name;
    std::uint64_t calls = 0;
    std::chrono::duration<double> total{0};
    Clock::time_point begin;
  };
  Stage& find(std::string_view name);

  std::vector<Stage> stages_;  // a handful: a linear search is quickest
};

}  // namespace vat
