#pragma once

#include <cstddef>

namespace vat {

/// Raises what this process may have open (RLIMIT_NOFILE) to `wanted`, or as far as the system
/// allows. What it may have open then.
std::size_t raise_open_files(std::size_t wanted);

}  // namespace vat
