#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/simulation/numerics_change.h"

namespace vat {

/// Numerics among which a session's governor chooses, with their measured error and cost.
struct GovernorPoint {
  NumericsChange numerics;
  double error = 0;    ///< relative error, see protocol/tune/TUNE.md
  double seconds = 1;  ///< computing time per simulated second [s]

  bool operator==(const GovernorPoint&) const = default;
};

inline constexpr std::size_t kMaxGovernorPoints = 16;

/// Reads the optional list `key`. The list is empty, or has at least two points with increasing
/// errors and decreasing times.
std::vector<GovernorPoint> read_governor_points(ObjectReader& reader, std::string_view key,
                                                Errors& errors);
Json write_governor_points(std::span<const GovernorPoint> points);

/// Returns the index of the first point whose numerics the scene has.
std::optional<std::size_t> find_point(std::span<const GovernorPoint> points, const Scene& scene);

}  // namespace vat
