#pragma once

#include <string>

#include "core/types.h"
#include "protocol/json/json_reader.h"

namespace vat::validation {

/// The value of tests/validation/reference.json at a JSON pointer such as "/rigid/RIG-1/energy".
/// Throws std::out_of_range, with the pointer, where there is none.
const Json& reference_at(const std::string& pointer);

/// The same as a number, or as a vector of three. Throw where it is something else.
Real reference(const std::string& pointer);
Vec3 reference_vector(const std::string& pointer);

}  // namespace vat::validation
