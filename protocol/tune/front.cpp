#include "protocol/tune/front.h"

#include <algorithm>
#include <sstream>
#include <tuple>

#include "core/support/check.h"

namespace vat::tune {
namespace {

std::string short_number(double value) {
  constexpr int kDigits = 3;
  std::ostringstream text;
  text.precision(kDigits);
  text << value;
  return text.str();
}

Error not_reached(std::string message) {
  return {"not_reached", "", std::move(message)};
}

}  // namespace

std::vector<Point> pareto_front(std::span<const Point> points) {
  std::vector<Point> sorted(points.begin(), points.end());
  std::ranges::stable_sort(sorted, [](const Point& a, const Point& b) {
    return std::tie(a.seconds, a.error) < std::tie(b.seconds, b.error);
  });
  std::vector<Point> front;
  for (const Point& point : sorted) {
    if (front.empty() || point.error < front.back().error) front.push_back(point);
  }
  return front;
}

Result<Point> choose_for_error(std::span<const Point> points, Real error, Real floor) {
  const std::vector<Point> front = pareto_front(points);
  if (front.empty()) return not_reached("no candidate has completed the run");
  for (const Point& point : front) {
    if (point.error <= error) return point;
  }
  std::string message = "no candidate has an error of at most " + short_number(error) +
                        "; the least error is " + short_number(front.back().error);
  if (floor > error) {
    message += ", and errors below the noise of the scene, " + short_number(floor) +
               ", cannot be measured";
  }
  return not_reached(std::move(message));
}

Result<Point> choose_for_real_time(std::span<const Point> points) {
  const Point* best = nullptr;
  for (const Point& point : points) {
    if (point.slowest > 1 - kReserve) continue;
    if (best == nullptr ||
        std::tie(point.error, point.seconds) < std::tie(best->error, best->seconds)) {
      best = &point;
    }
  }
  if (best != nullptr) return *best;
  if (points.empty()) return not_reached("no candidate has completed the run");
  const Point& fastest = std::ranges::min(points, {}, &Point::slowest);
  return not_reached("no candidate leaves " + short_number(100 * kReserve) +
                     " % of real time free; the fastest one needs " +
                     short_number(fastest.slowest) + " s per simulated second");
}

std::vector<Point> cheaper_points(std::span<const Point> points, const Point& choice,
                                  std::size_t most) {
  VAT_CHECK(most >= 2);
  std::vector<Point> cheaper;
  for (const Point& point : pareto_front(points)) {
    if (point.seconds < choice.seconds && point.error > choice.error) cheaper.push_back(point);
  }
  cheaper.push_back(choice);
  std::ranges::reverse(cheaper);
  if (cheaper.size() <= most) return cheaper;
  std::vector<Point> spread;
  for (std::size_t i = 0; i < most; ++i) {
    spread.push_back(cheaper[i * (cheaper.size() - 1) / (most - 1)]);
  }
  return spread;
}

}  // namespace vat::tune
