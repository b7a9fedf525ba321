#include "tests/support/memory/allocation_counter.h"

#include <cstdlib>
#include <limits>
#include <new>
#include <utility>

// Replaces the program's allocation functions. The other forms of operator new and delete call
// these. They are in a separate file because a compiler would warn about passing memory of operator
// new to free.

namespace {

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

thread_local std::size_t count = 0;
thread_local std::size_t allowed_count = kUnlimited;

void* allocate(std::size_t size, std::size_t alignment) {
  if (count >= allowed_count) throw std::bad_alloc();
  ++count;
  const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
  if (void* memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded)) {
    return memory;
  }
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  return allocate(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<std::size_t>(alignment));
}
// The library's version calls the function above, but a sanitizer's version does not. Its memory
// must not be passed to free.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  const std::size_t allowed = std::exchange(allowed_count, kUnlimited);
  void* memory = nullptr;
  try {
    memory = operator new(size);
  } catch (const std::bad_alloc&) {
  }
  allowed_count = allowed;
  return memory;
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace vat::test {

std::size_t allocation_count() {
  return count;
}

AllocationLimit::AllocationLimit(std::size_t allowed) {
  allowed_count = count + allowed;
}
AllocationLimit::~AllocationLimit() {
  allowed_count = kUnlimited;
}

}  // namespace vat::test
