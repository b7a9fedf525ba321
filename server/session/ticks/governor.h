#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "server/people/governor_points.h"

namespace vat {

/// Measurement of a playing session since the previous sample.
struct GovernorSample {
  double seconds = 0;      ///< wall time [s]
  bool is_behind = false;  ///< whether the session is slower than its requested speed
  double load = 0;         ///< time of the ticks relative to their period
};

/// Chooses among the points of a Pareto front by the speed of a session. The points are ordered by
/// decreasing accuracy and cost. The rules:
///
/// - after kBehindSeconds behind the requested speed: the next cheaper point that has not failed;
/// - after kReserveSeconds without a delay, in which the load predicted for the next more accurate
///   point was always at most kMostLoad: this point. The prediction is the load times the ratio of
///   the measured times of both points;
/// - a point that falls behind within kTrialSeconds after a return to it has failed. The governor
///   does not use it for kLeastWait, and twice as long after each further failure, up to kMostWait.
///   A point that the governor used for kTrialSeconds after a return has no failures.
///
/// Has no clock. Not thread-safe.
class Governor {
 public:
  static constexpr double kBehindSeconds = 3;
  static constexpr double kReserveSeconds = 10;
  static constexpr double kMostLoad = 0.8;
  static constexpr double kTrialSeconds = 60;
  static constexpr double kLeastWait = 30;
  static constexpr double kMostWait = 3600;

  /// Returns the index of the point to change to, or nothing. `point` is the index of the present
  /// point. The next sample shows by its `point` whether the change was made.
  std::optional<std::size_t> add(const GovernorSample& sample, std::size_t point,
                                 std::span<const GovernorPoint> points);
  /// Notes that a point has failed, or that the session could not change to it.
  void fail(std::size_t point);
  /// Discards the measured times after a pause. Failures remain.
  void restart();

 private:
  std::optional<std::size_t> find_cheaper(std::size_t point, std::size_t count);
  void note_point(std::size_t point);
  void wait(double seconds);

  std::array<double, kMaxGovernorPoints> waits_{};  // remaining times without use [s]
  std::array<std::uint32_t, kMaxGovernorPoints> failures_{};
  std::optional<std::size_t> point_;   // point of the last sample
  std::optional<std::size_t> return_;  // more accurate point that add() returned last
  double behind_ = 0;                  // [s]
  double reserve_ = 0;                 // [s]
  double trial_ = 0;                   // remaining trial of point_ [s]
};

}  // namespace vat
