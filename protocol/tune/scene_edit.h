#pragma once

#include <string>
#include <string_view>

#include "core/support/result.h"
#include "protocol/tune/candidates.h"

namespace vat::tune {

/// Returns the text of a scene file with the numerics of a candidate. Only the values of the
/// members `numerics`, and for liquids `pressure_solver` and `incompressible`, are replaced. Every
/// other byte is unchanged, including order and white space. Missing members are inserted after
/// `numerics`, or at the beginning. `text` must be valid JSON, and its root an object. Fails if it
/// is not.
Result<std::string> with_numerics(std::string_view text, const Candidate& candidate,
                                  bool has_liquid);

}  // namespace vat::tune
