#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/support/check.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// A table with a list of other particles for each particle, in ascending order. Each block of
/// particles has a separate buffer, so that blocks can be filled in parallel.
class PairTable {
 public:
  /// Fills the table for `count` particles. find(i, found) must append the list of particle i to
  /// `found`. The list may be unordered and contain duplicates.
  template <class Find>
  void fill(TaskRunner* runner, std::size_t count, Find&& find) {
    blocks_.resize(block_count(count));
    for_blocks(runner, count, [&](std::size_t begin, std::size_t end) {
      Block& block = blocks_[begin / kBlockSize];
      block.others.clear();
      for (std::size_t i = begin; i < end; ++i) {
        const auto first = static_cast<std::ptrdiff_t>(block.others.size());
        block.begin[i - begin] = static_cast<Index>(first);
        find(static_cast<Index>(i), block.others);
        std::sort(block.others.begin() + first, block.others.end());
        block.others.erase(std::unique(block.others.begin() + first, block.others.end()),
                           block.others.end());
      }
      block.begin[end - begin] = static_cast<Index>(block.others.size());
    });
  }

  std::span<const Index> of(Index i) const {
    VAT_CHECK(i / kBlockSize < blocks_.size());
    const Block& block = blocks_[i / kBlockSize];
    const Index begin = block.begin[i % kBlockSize];
    return {block.others.data() + begin, block.begin[i % kBlockSize + 1] - begin};
  }

  /// Returns the total number of entries.
  std::size_t size() const {
    std::size_t size = 0;
    for (const Block& block : blocks_) size += block.others.size();
    return size;
  }

 private:
  /// The entries of the k-th particle are [begin[k], begin[k + 1]).
  struct Block {
    std::vector<Index> others;
    std::array<Index, kBlockSize + 1> begin;
  };
  std::vector<Block> blocks_;
};

}  // namespace vat
