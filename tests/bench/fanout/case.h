#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "tests/bench/fanout/load.h"

namespace vat::bench {

/// Viewers of one session on loopback.
struct FanoutCase {
  std::string name;
  ViewerCounts viewers{};  ///< by ViewerKind
  std::size_t endpoints = 1;
};

struct FanoutSettings {
  std::string program;   ///< `vat`
  std::string scene;     ///< file
  double max_error = 0;  ///< [m] that viewers ask for
  double seconds = 10;   ///< measured
};

/// What one kind of viewer has seen, and what the server has spent meanwhile.
struct FanoutResult {
  static constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  std::string name;
  ViewerKind kind = ViewerKind::plain;
  std::size_t viewers = 0;  ///< of the kind
  std::size_t endpoints = 0;
  double frames_per_second = 0;  ///< that each has got
  double frame_bytes = kAbsent;
  double age_median = kAbsent;  ///< [s] of frames
  double age_99 = kAbsent;
  double first_frame_99 = kAbsent;  ///< [s] from subscription
  std::size_t joins = 0;
  std::size_t closed = 0;          ///< by the server
  double delivery_per_viewer = 0;  ///< of all kinds: cores that make and send frames
  double processor = 0;            ///< cores, with the session's
  double resident_megabytes = 0;   ///< of the server
  double tick_median = 0;          ///< [s]
  double tick_99 = 0;
  double lateness_99 = 0;  ///< [s] of ticks
};

const std::vector<FanoutCase>& fanout_cases();

/// Frames a second, as the scene's ticks.
inline constexpr double kFullRate = 30;
/// The bytes of a frame, from a second with one viewer.
double measure_frame(LoadSettings settings);

/// Runs a case: a row for each kind of viewer that it has. Throws std::runtime_error where the
/// server or the viewers fail.
std::vector<FanoutResult> run_fanout(const FanoutCase& one, const FanoutSettings& settings);

}  // namespace vat::bench
