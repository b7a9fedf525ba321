#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace vat {

/// Returns the header of an array in NumPy's format 1.0. `type` is for example "<f8". The header
/// has a fixed size.
std::string array_header(const char* type, const std::vector<std::size_t>& shape);

}  // namespace vat
