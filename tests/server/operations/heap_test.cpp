#include "server/operations/heap.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "tests/support/memory/allocator.h"
#include "tests/support/memory/resident_bytes.h"

#if VAT_HAS_SYSTEM_ALLOCATOR

namespace vat::test::heap_test {
namespace {

using namespace std::chrono_literals;

TEST(Heap, InUseIsTheDifferenceOfAllocatedAndFreed) {
  const std::size_t before = heap_in_use();
  auto small = std::make_unique<std::array<char, 1'000'000>>();
  auto large = std::make_unique<std::array<char, 10'000'000>>();  // allocated by mmap
  EXPECT_NEAR(static_cast<double>(heap_in_use() - before), 11e6, 1e5);
  small.reset();
  large.reset();
  EXPECT_NEAR(static_cast<double>(heap_in_use()), static_cast<double>(before), 1e5);
}

// One in 256 small blocks of another thread stays in use. The allocator does not release memory by
// itself, because a used block is at the end of its arena.
TEST(Heap, ReturnsFreePagesBetweenUsedOnes) {
  constexpr std::size_t kPieces = 100'000;
  constexpr std::size_t kPieceBytes = 400;
  constexpr double kGiven = 0.9 * kPieces * kPieceBytes;
  std::vector<std::string> pieces(kPieces);
  std::thread([&] {
    for (std::string& piece : pieces) piece.assign(kPieceBytes, 'x');
  }).join();
  for (std::size_t i = 0; i < kPieces; ++i) {
    if (i % 256 != 255) std::string().swap(pieces[i]);
  }
  const double before = resident_bytes();
  boost::asio::io_context io;
  MemoryReturn memory_return(io, 10ms);
  for (int i = 0; i < 100 && before - resident_bytes() < kGiven; ++i) io.run_one();
  EXPECT_GT(before - resident_bytes(), kGiven);
}

}  // namespace
}  // namespace vat::test::heap_test
#endif  // VAT_HAS_SYSTEM_ALLOCATOR
