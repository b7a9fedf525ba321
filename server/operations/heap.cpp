#include "server/operations/heap.h"

#include <malloc.h>

namespace vat {
namespace {

constexpr int kArenas = 2;
constexpr int kLarge = 256 * 1024;  // [bytes]

}  // namespace

void prepare_heap() {
  mallopt(M_ARENA_MAX, kArenas);
  mallopt(M_MMAP_THRESHOLD, kLarge);
}

std::size_t heap_in_use() {
  const auto heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

void MemoryReturn::wait() {
  timer_.expires_after(interval_);
  timer_.async_wait([this](const boost::system::error_code& cancelled) {
    if (cancelled) return;
    malloc_trim(0);
    wait();
  });
}

}  // namespace vat
