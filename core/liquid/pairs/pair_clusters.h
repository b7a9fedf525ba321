#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "core/liquid/pairs/pair_sums.h"
#include "core/neighbours/uniform_grid.h"
#include "core/support/parallel.h"
#include "core/types.h"

namespace vat {

/// Sources in the order of a grid's cells: slot s is source first + s.
struct SourceGroup {
  const UniformGrid* grid = nullptr;
  Index first = 0;
};

/// Coordinates of all sources for the search, about a common origin: rounded, as culling may be
/// generous.
struct SearchPlaces {
  Vec3 origin = Vec3::Zero();
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
};

/// How pairs are searched for.
struct PairSearch {
  Real reach = 0;             ///< [m] pairs further apart need not be found
  Index padding = 0;          ///< source that adds nothing to any sum
  Index first_mirrored = 0;   ///< sources from here on are images in walls
  std::size_t most_work = 0;  ///< targets times candidates, in all; beyond, there are none
  InstructionSet instructions = InstructionSet::baseline;
};

/// All pairs of targets and sources within a reach of each other, as clusters of targets and the
/// candidates of each: memory is by cluster, not by pair.
class PairClusters {
 public:
  /// Of each target in `targets` with all sources of `groups`, the last liquid's images in walls.
  /// False where there was too much work; which clusters went without candidates then depends on
  /// threads.
  bool build(const PairSearch& search, const SourceGroup& targets, const SearchPlaces& places,
             std::span<const SourceGroup> groups, TaskRunner* runner);

  /// Calls f(inputs, clusters) for parts of them, side by side, with `inputs` and the candidates.
  template <class F>
  void for_each_chunk(TaskRunner* runner, const PairInputs& inputs, F&& f) const {
    for_blocks<1>(runner, chunks_.size(), [&](std::size_t begin, std::size_t) {
      const Chunk& chunk = chunks_[begin];
      PairInputs in = inputs;
      in.candidates = chunk.candidates.data();
      f(in, std::span<const TargetCluster>(chunk.clusters));
    });
  }

  /// Calls f(cluster, target, sums) for each source that is a target, those of a part one after the
  /// other, with the `width` numbers that `sum` gives for it.
  template <std::size_t width, class F>
  void for_each_sum(TaskRunner* runner, const PairInputs& inputs, PairSums::Function sum,
                    F&& f) const {
    for_each_chunk(runner, inputs, [&](const PairInputs& in, auto clusters) {
      std::array<Real, width * kTargetsAtOnce> sums;
      for (; !clusters.empty(); clusters = clusters.subspan(size_of_batch(clusters))) {
        const auto batch = clusters.first(size_of_batch(clusters));
        const Index first = batch.front().begin;
        sum(in.from_target(first), batch, sums.data());
        for (const TargetCluster& cluster : batch) {
          for (Index n = cluster.begin; n < cluster.end; ++n) {
            f(cluster, n, &sums[width * (n - first)]);
          }
        }
      }
    });
  }

 private:
  static constexpr Index kTargetsAtOnce = 256;

  /// How many of the clusters, one behind the other, have no more targets than that together.
  static std::size_t size_of_batch(std::span<const TargetCluster> clusters) {
    const auto beyond = std::ranges::find_if(clusters, [&](const TargetCluster& cluster) {
      return cluster.end - clusters.front().begin > kTargetsAtOnce;
    });
    return static_cast<std::size_t>(beyond - clusters.begin());
  }

  /// Of the cells that begin in one block of slots.
  struct Chunk {
    std::vector<TargetCluster> clusters;
    std::vector<Index> candidates;
  };

  std::vector<Chunk> chunks_;
};

}  // namespace vat
