#pragma once

#include <algorithm>
#include <array>

#include "core/model/model.h"
#include "core/support/check.h"
#include "core/support/parallel.h"

namespace vat {

/// Sums for the particles of one block.
using BlockSums = std::array<Vec3, kBlockSize>;

/// Calls body(begin, end) for the particles with explicit springs, in the blocks of all particles.
template <class Body>
void for_spring_blocks(const Model& model, TaskRunner* runner, Body&& body) {
  const std::size_t base = model.liquid_count / kBlockSize * kBlockSize;
  for_blocks(runner, model.implicit_begin - base, [&](std::size_t begin, std::size_t end) {
    body(std::max(static_cast<Index>(base + begin), model.liquid_count),
         static_cast<Index>(base + end));
  });
}

/// Sums the forces of springs on the particles [begin, end) of one block. `at_particle(e)` returns
/// a function that maps a spring end of particle e to the force on e. The other particle of the
/// spring gets the opposite force. Each spring is evaluated once in each block that contains one of
/// its ends.
template <class F>
void sum_over_springs(const Model& model, Index begin, Index end, BlockSums& sums,
                      F&& at_particle) {
  VAT_CHECK(begin <= end && end - begin <= sums.size());
  const SpringEnd* const ends = model.spring_ends.data();
  std::fill_n(sums.begin(), end - begin, Vec3::Zero());
  for (Index e = begin; e < end; ++e) {
    const IndexRange own{model.spring_own_begin[e], model.spring_begin[e + 1]};
    // springs from earlier blocks
    IndexRange from_before{model.spring_begin[e], model.spring_begin[e]};
    while (from_before.end < own.begin && ends[from_before.end].other < begin) ++from_before.end;
    const auto at_end = at_particle(e);
    Vec3 sum = sums[e - begin];
    for (const IndexRange& range : {from_before, own}) {
      for (Index s = range.begin; s < range.end; ++s) {
        const Vec3 part = at_end(s);
        sum += part;
        const Index other = ends[s].other - begin;  // wraps around for particles before the block
        if (other < end - begin) sums[other] -= part;
      }
    }
    sums[e - begin] = sum;
  }
}

}  // namespace vat
