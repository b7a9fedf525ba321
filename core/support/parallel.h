#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace vat {

/// Runs independent blocks of work. run() calls `block(0) … block(n-1)`, each exactly once, in any
/// order and from any thread. run() returns when all calls have ended. ThreadPoolRunner has
/// threads.
class TaskRunner {
 public:
  virtual ~TaskRunner() = default;
  virtual void run(std::size_t block_count, const std::function<void(std::size_t)>& block) = 0;
  virtual std::size_t thread_count() const = 0;
};

/// Block size of all parallel passes and reductions. The size is constant, so that the order of
/// sums, and therefore every bit of a result, does not depend on the number of threads.
inline constexpr std::size_t kBlockSize = 256;

/// Returns the number of blocks of `size` elements for `count` elements.
constexpr std::size_t block_count(std::size_t count, std::size_t size = kBlockSize) {
  return (count + size - 1) / size;
}

/// Calls `body(begin, end)` for the blocks of [0, count). Runs serially if `runner` is null, if it
/// has fewer than two threads, or if there is only one block. `body` may write only to its own
/// range.
template <std::size_t size = kBlockSize, class Body>
void for_blocks(TaskRunner* runner, std::size_t count, Body&& body) {
  static_assert(size > 0);
  const std::size_t blocks = block_count(count, size);
  const auto block = [&](std::size_t b) { body(b * size, std::min(count, (b + 1) * size)); };
  if (runner == nullptr || runner->thread_count() < 2 || blocks < 2) {
    for (std::size_t b = 0; b < blocks; ++b) block(b);
  } else {
    runner->run(blocks, block);
  }
}

}  // namespace vat
