#pragma once

#include <string>

#include "core/types.h"
#include "protocol/json/json_reader.h"

namespace vat::validation {

/// Returns the value of tests/validation/reference.json at a JSON pointer such as
/// "/rigid/RIG-1/energy". Throws std::out_of_range with the pointer if there is none.
const Json& reference_at(const std::string& pointer);

/// Return the value as a number, or as a vector of three. Throw if it has another type.
Real reference(const std::string& pointer);
Vec3 reference_vector(const std::string& pointer);

}  // namespace vat::validation
