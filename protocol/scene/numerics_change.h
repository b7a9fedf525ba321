#pragma once

#include "core/simulation/numerics_change.h"
#include "protocol/json/json_reader.h"

namespace vat {

/// Reads the members `integrator`, `step`, `control`, `tolerance`, `density_tolerance` and
/// `divergence_tolerance` of an object. All are optional. The core checks their ranges.
NumericsChange read_numerics_change(ObjectReader& reader);
/// Returns an object with the values that are present.
Json write_numerics_change(const NumericsChange& change);

}  // namespace vat
