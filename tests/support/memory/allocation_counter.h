#pragma once

#include <cstddef>

namespace vat::test {

/// Returns the number of calls of operator new by this thread since its start.
std::size_t allocation_count();

/// Makes throwing calls of operator new fail on this thread after the first `allowed` calls, during
/// its lifetime.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t allowed);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;
};

}  // namespace vat::test
