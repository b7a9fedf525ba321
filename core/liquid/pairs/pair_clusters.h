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

/// A group of sources, which are particles or images, sorted by grid cell: slot s is source first +
/// s.
struct SourceGroup {
  const UniformGrid* grid = nullptr;
  Index first = 0;
};

/// Single-precision coordinates of all sources relative to a common origin, for the search. The
/// search adds a margin for the rounding errors.
struct SearchCoordinates {
  Vec3 origin = Vec3::Zero();
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
};

/// Parameters of the search for pairs.
struct PairSearch {
  Real reach = 0;             ///< maximum distance of pairs [m]
  Index padding = 0;          ///< index of a source that adds nothing to sums
  Index first_mirrored = 0;   ///< sources with this index or a greater one are images in walls
  std::size_t most_work = 0;  ///< upper limit of the sum over clusters of (targets × candidates)
  InstructionSet instructions = InstructionSet::baseline;
};

/// All pairs of targets and sources within a maximum distance, stored as clusters of targets with a
/// common list of candidate sources (TargetCluster). Memory is proportional to the number of
/// clusters, not to the number of pairs.
class PairClusters {
 public:
  /// Finds the pairs of each target in `targets` with all sources of `groups`. The last group must
  /// consist of images of liquid in walls. Returns false if the work exceeds search.most_work. In
  /// this case, some clusters have no candidates. The selection of these clusters depends on the
  /// thread schedule.
  bool build(const PairSearch& search, const SourceGroup& targets, const SearchCoordinates& places,
             std::span<const SourceGroup> groups, TaskRunner* runner);

  /// Calls f(inputs, clusters) for each chunk of clusters in parallel. The first argument is
  /// `inputs` with the candidates of the chunk.
  template <class F>
  void for_each_chunk(TaskRunner* runner, const PairInputs& inputs, F&& f) const {
    for_blocks<1>(runner, chunks_.size(), [&](std::size_t begin, std::size_t) {
      const Chunk& chunk = chunks_[begin];
      PairInputs in = inputs;
      in.candidates = chunk.candidates.data();
      f(in, std::span<const TargetCluster>(chunk.clusters));
    });
  }

  /// Calls f(cluster, target, sums) for each target, in order within each chunk. `sums` points to
  /// the `width` numbers that `sum` computes for the target.
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
  /// Calls f(cluster, target, sums) like for_each_sum(), for the clusters with takes(cluster).
  template <std::size_t width, class Takes, class F>
  void for_some_sums(TaskRunner* runner, const PairInputs& inputs, PairSums::Function sum,
                     Takes&& takes, F&& f) const {
    for_each_chunk(runner, inputs, [&](const PairInputs& in, auto clusters) {
      std::array<Real, width * kMaxTargets> sums;
      for (const TargetCluster& cluster : clusters) {
        if (!takes(cluster)) continue;
        sum(in.from_target(cluster.begin), {&cluster, 1}, sums.data());
        for (Index n = cluster.begin; n < cluster.end; ++n) {
          f(cluster, n, &sums[width * (n - cluster.begin)]);
        }
      }
    });
  }

 private:
  static constexpr Index kTargetsAtOnce = 256;

  /// Returns the number of leading clusters with at most kTargetsAtOnce targets in total.
  static std::size_t size_of_batch(std::span<const TargetCluster> clusters) {
    const auto beyond = std::ranges::find_if(clusters, [&](const TargetCluster& cluster) {
      return cluster.end - clusters.front().begin > kTargetsAtOnce;
    });
    return static_cast<std::size_t>(beyond - clusters.begin());
  }

  /// The clusters of one block of slots. A cell belongs to the block that contains its first slot.
  struct Chunk {
    std::vector<TargetCluster> clusters;
    std::vector<Index> candidates;
  };

  std::vector<Chunk> chunks_;
};

}  // namespace vat
