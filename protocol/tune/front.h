#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/support/result.h"
#include "core/types.h"

namespace vat::tune {

/// Measured cost and error of one candidate.
struct Point {
  std::size_t candidate = 0;  ///< index
  double seconds = 0;         ///< computing time per simulated second [s]
  double slowest = 0;         ///< the same in the slowest part of the run [s]
  Real error = 0;             ///< at least the noise floor
};

/// Share of real time that a choice for real time leaves free.
inline constexpr double kReserve = 0.2;

/// Returns the points that no other point dominates, by ascending time. A point dominates another
/// one if its time and its error are at most as large, and one of them is smaller. Of equal points,
/// the first one remains.
std::vector<Point> pareto_front(std::span<const Point> points);

/// Returns the point with the least time and an error of at most `error`. Fails if the floor is
/// above `error`, or no point has such an error. Code: not_reached.
Result<Point> choose_for_error(std::span<const Point> points, Real error, Real floor);

/// Returns the point with the least error that needs at most 1 - kReserve of real time in every
/// part of the run. Of equal errors, returns the point with the least time. Fails if no point is
/// fast enough. Code: not_reached.
Result<Point> choose_for_real_time(std::span<const Point> points);

/// Returns `choice`, and then the points of the Pareto front that need less time and have a greater
/// error, by descending time. If there are more than `most` points, returns `most` of them, evenly
/// distributed from the first to the last one. `most` must be at least 2.
std::vector<Point> cheaper_points(std::span<const Point> points, const Point& choice,
                                  std::size_t most);

}  // namespace vat::tune
