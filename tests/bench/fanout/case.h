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
  std::string program;       ///< `vat`
  std::string scene;         ///< file
  std::string solids_scene;  ///< file of the scene for silent viewers, with a long description
  double max_error = 0;      ///< [m] maximum error that viewers request
  double seconds = 10;       ///< measured
};

/// Results of one kind of viewer, and the cost of the server meanwhile.
struct FanoutResult {
  static constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();
  std::string name;
  ViewerKind kind = ViewerKind::plain;
  std::size_t viewers = 0;  ///< number of viewers of the kind
  std::size_t endpoints = 0;
  double frames_per_second = 0;  ///< mean per viewer
  double frame_bytes = kAbsent;
  double age_median = kAbsent;  ///< [s] of frames
  double age_99 = kAbsent;
  double first_frame_99 = kAbsent;  ///< [s] from subscription
  std::size_t joins = 0;
  std::size_t closed = 0;          ///< closed by the server
  double delivery_per_viewer = 0;  ///< over all kinds: cores that make and send frames
  double processor = 0;            ///< cores, including the session's
  double resident_megabytes = 0;   ///< of the server
  double tick_median = 0;          ///< [s]
  double tick_99 = 0;
  double lateness_99 = 0;           ///< [s] of ticks
  double ticks = 0;                 ///< per second
  double kilobytes_per_viewer = 0;  ///< growth of the server's memory / viewers of all kinds
};

const std::vector<FanoutCase>& fanout_cases();

/// Frames per second, equal to the scene's tick rate.
inline constexpr double kFullRate = 30;
/// Returns the bytes per frame, from one second with one viewer.
double measure_frame(LoadSettings settings);

/// Adds the measurements of other viewers.
void append(LoadSightings& all, const LoadSightings& more);
/// Returns the results of viewers of one kind that were measured for `seconds`.
FanoutResult summarise(const Sightings& seen, std::size_t viewers, double seconds);

/// Runs a case. Returns a row for each kind of viewer. Throws std::runtime_error if the server or
/// the viewers fail.
std::vector<FanoutResult> run_fanout(const FanoutCase& one, const FanoutSettings& settings);

}  // namespace vat::bench
