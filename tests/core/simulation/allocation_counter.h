#pragma once

#include <cstddef>

namespace vat::test {

/// Calls of operator new by this thread since it began.
std::size_t allocation_count();

/// While it lives, this thread's calls of operator new that may throw do, after the first
/// `allowed`.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t allowed);
  ~AllocationLimit();
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;
};

}  // namespace vat::test
