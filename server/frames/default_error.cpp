#include "server/frames/default_error.h"

#include <algorithm>

namespace vat {
namespace {

constexpr double kSpacingsPerRadius = 2;
constexpr double kErrorsPerSpacing = 64;

}  // namespace

double default_max_error(const Simulation& simulation) {
  double least = 0;
  for (const BodyView& body : simulation.bodies()) {
    if (body.kind == BodyKind::rigid || body.radii.empty()) continue;
    const double radius = std::ranges::max(body.radii);
    least = least == 0 ? radius : std::min(least, radius);
  }
  return kSpacingsPerRadius * least / kErrorsPerSpacing;
}

}  // namespace vat
