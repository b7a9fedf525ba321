#pragma once

#include <cstddef>

namespace vat::test {

/// Calls of operator new by this thread since it began.
std::size_t allocation_count();

}  // namespace vat::test
