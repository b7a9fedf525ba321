#pragma once

#include <cstddef>

namespace vat {

/// Increases the limit of open files (RLIMIT_NOFILE) to `wanted`, or to the system's maximum.
/// Returns the new limit.
std::size_t raise_open_files(std::size_t wanted);

}  // namespace vat
