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

/// Sources in the order of the cells of a grid: slot s is source first + s.
struct SourceGroup {
  const UniformGrid* grid = nullptr;
  Index first = 0;
};

/// Coordinates of all sources for the search, relative to a common origin. They are rounded; the
/// search adds a margin.
struct SearchCoordinates {
  Vec3 origin = Vec3::Zero();
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
};

/// Parameters of the search of pairs.
struct PairSearch {
  Real reach = 0;             ///< maximum distance of pairs [m]
  Index padding = 0;          ///< index of a source that adds nothing to sums
  Index first_mirrored = 0;   ///< sources from here on are images in walls
  std::size_t most_work = 0;  ///< maximum of targets times candidates in total
  InstructionSet instructions = InstructionSet::baseline;
};

/// All pairs of targets and sources within a reach, stored as clusters of targets with their
/// candidates. Memory grows with the number of clusters, not of pairs.
class PairClusters {
 public:
  /// Finds the pairs of each target in `targets` with all sources of `groups`; the last group is
  /// images of liquid in walls. Returns false if the work exceeds the limit. The clusters without
  /// candidates then depend on the threads.
  bool build(const PairSearch& search, const SourceGroup& targets, const SearchCoordinates& places,
             std::span<const SourceGroup> groups, TaskRunner* runner);

  /// Calls f(inputs, clusters) for parts of the clusters in parallel. `inputs` has the candidates
  /// of the part.
  template <class F>
  void for_each_chunk(TaskRunner* runner, const PairInputs& inputs, F&& f) const {
    for_blocks<1>(runner, chunks_.size(), [&](std::size_t begin, std::size_t) {
      const Chunk& chunk = chunks_[begin];
      PairInputs in = inputs;
      in.candidates = chunk.candidates.data();
      f(in, std::span<const TargetCluster>(chunk.clusters));
    });
  }

  /// Calls f(cluster, target, sums) for each target, in order within each part, with the `width`
  /// numbers of `sum`.
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

  /// The number of leading clusters that have at most kTargetsAtOnce targets together.
  static std::size_t size_of_batch(std::span<const TargetCluster> clusters) {
    const auto beyond = std::ranges::find_if(clusters, [&](const TargetCluster& cluster) {
      return cluster.end - clusters.front().begin > kTargetsAtOnce;
    });
    return static_cast<std::size_t>(beyond - clusters.begin());
  }

  /// The clusters of the cells that begin in one block of slots.
  struct Chunk {
    std::vector<TargetCluster> clusters;
    std::vector<Index> candidates;
  };

  std::vector<Chunk> chunks_;
};

}  // namespace vat
