#include "server/people/governor_points.h"

#include <algorithm>
#include <utility>

namespace vat {
namespace {

constexpr double kMaxPointError = 1e6;
constexpr double kMinPointSeconds = 1e-9;
constexpr double kMaxPointSeconds = 1e6;

GovernorPoint read_point(const Json& value, const std::string& path, Errors& errors) {
  ObjectReader reader(value, path, errors);
  GovernorPoint point;
  point.numerics = read_numerics_change(reader);
  if (point.numerics == NumericsChange{}) {
    add_error(errors, "missing", path, "must have a member of world.set_numerics");
  }
  point.error = reader.real("error", 0, kMaxPointError);
  point.seconds = reader.real("seconds", kMinPointSeconds, kMaxPointSeconds);
  reader.refuse_unknown();
  return point;
}

void check_point_order(std::span<const GovernorPoint> points, const std::string& path,
                       Errors& errors) {
  if (points.size() == 1) add_error(errors, "too_few", path, "must have no or at least 2 points");
  for (std::size_t i = 1; i < points.size(); ++i) {
    const std::string at = pointer_to(path, i);
    if (!(points[i].error > points[i - 1].error)) {
      add_error(errors, "out_of_order", at + "/error", "must exceed that of the previous point");
    }
    if (!(points[i].seconds < points[i - 1].seconds)) {
      add_error(errors, "out_of_order", at + "/seconds",
                "must be less than that of the previous point");
    }
  }
}

}  // namespace

std::vector<GovernorPoint> read_governor_points(ObjectReader& reader, std::string_view key,
                                                Errors& errors) {
  const Json* const list = reader.array(key, kMaxGovernorPoints);
  if (list == nullptr) return {};
  const std::string path = reader.path_of(key);
  const std::size_t errors_before = errors.size();
  std::vector<GovernorPoint> points;
  for (std::size_t i = 0; i < list->size(); ++i) {
    points.push_back(read_point((*list)[i], pointer_to(path, i), errors));
  }
  if (errors.size() == errors_before) check_point_order(points, path, errors);
  return points;
}

Json write_governor_points(std::span<const GovernorPoint> points) {
  Json list = Json::array();
  for (const GovernorPoint& point : points) {
    Json written = write_numerics_change(point.numerics);
    written["error"] = point.error;
    written["seconds"] = point.seconds;
    list.push_back(std::move(written));
  }
  return list;
}

std::optional<std::size_t> find_point(std::span<const GovernorPoint> points, const Scene& scene) {
  const auto found = std::ranges::find_if(
      points, [&](const GovernorPoint& point) { return has_numerics(scene, point.numerics); });
  if (found == points.end()) return {};
  return static_cast<std::size_t>(found - points.begin());
}

}  // namespace vat
