#include "core/liquid/pairs/pair_clusters.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "core/support/check.h"
#include "core/support/grow.h"

namespace vat {
namespace {

/// The box around some sources, in the coordinates of the search.
struct SearchBox {
  std::array<float, 3> low{};
  std::array<float, 3> high{};

  SearchBox() {
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
  }
  /// The maximum coordinate in magnitude.
  Real greatest() const {
    float most = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      most = std::max({most, std::abs(low[axis]), std::abs(high[axis])});
    }
    return static_cast<Real>(most);
  }
  void extend(const SearchCoordinates& places, Index source) {
    const std::array<float, 3> p = {places.x[source], places.y[source], places.z[source]};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
};

Vec3 to_point(const SearchCoordinates& places, const std::array<float, 3>& p) {
  return places.origin +
         Vec3(static_cast<Real>(p[0]), static_cast<Real>(p[1]), static_cast<Real>(p[2]));
}

/// Provides space for `wanted` entries.
void make_room_for_found(std::vector<Index>& found, std::size_t wanted) {
  if (found.size() < wanted) resize_closely(found, wanted);
}

/// Appends the clusters of the cells that begin in slots [begin, end).
void collect_targets(const SourceGroup& targets, std::size_t begin, std::size_t end,
                     std::vector<TargetCluster>& clusters) {
  const std::span<const Index> cells = targets.grid->cell_begin();
  const auto first = std::ranges::lower_bound(cells, static_cast<Index>(begin));
  for (auto cell = first; cell + 1 < cells.end() && *cell < end; ++cell) {
    const Index count = *(cell + 1) - *cell;
    if (count == 0) continue;
    const Index parts = (count + kMaxTargets - 1) / kMaxTargets;
    for (Index part = 0; part < parts; ++part) {
      TargetCluster& cluster = clusters.emplace_back();
      cluster.begin = targets.first + *cell + count * part / parts;
      cluster.end = targets.first + *cell + count * (part + 1) / parts;
    }
  }
}

/// Slots of a chunk: small enough that threads share a thousand particles evenly.
constexpr std::size_t kChunkSize = 128;

/// Finds the candidates of clusters in sequence.
class CandidateSearch {
 public:
  CandidateSearch(const PairSearch& search, const SearchCoordinates& places,
                  std::span<const SourceGroup> groups)
      : search_(search),
        places_(places),
        groups_(groups),
        cull_(cull_function(search.instructions)),
        lanes_(lane_count(search.instructions)) {}

  /// Appends the candidates to `found` from `count` on, and returns the new count.
  std::size_t find(TargetCluster& cluster, std::vector<Index>& found, std::size_t count) const {
    SearchBox box;
    for (Index i = cluster.begin; i < cluster.end; ++i) box.extend(places_, i);
    // More than the rounding errors of coordinates and their differences.
    const Real reach = search_.reach * (1 + 1e-6) + 4e-7 * box.greatest();
    const Vec3 low = to_point(places_, box.low);
    const Vec3 high = to_point(places_, box.high);
    const CullBox near{box.low.data(), box.high.data(), static_cast<float>(reach)};
    cluster.center = (low + high) / 2;
    cluster.first_candidate = count;
    for (const SourceGroup& group : groups_) {
      cluster.mirrored_begin = static_cast<Index>(count - cluster.first_candidate);
      const CullSlots slots{places_.x.data() + group.first, places_.y.data() + group.first,
                            places_.z.data() + group.first, group.first};
      const auto cull = [&](Index begin, Index end) {
        make_room_for_found(found, count + (end - begin) + lanes_);
        count = cull_(slots, begin, end, near, found.data(), count);
      };
      group.grid->for_each_run(low.array() - reach, high.array() + reach, cull);
    }
    cluster.has_mirrored =
        count > cluster.first_candidate && found[count - 1] >= search_.first_mirrored;
    make_room_for_found(found, count + lanes_);
    const std::size_t rest = (count - cluster.first_candidate) % lanes_;
    if (rest > 0) {
      std::fill_n(found.begin() + static_cast<std::ptrdiff_t>(count), lanes_ - rest,
                  search_.padding);
      count += lanes_ - rest;
    }
    cluster.candidate_count = static_cast<Index>(count - cluster.first_candidate);
    VAT_CHECK(count <= found.size());
    return count;
  }

 private:
  const PairSearch& search_;
  const SearchCoordinates& places_;
  const std::span<const SourceGroup> groups_;
  const CullFunction cull_;
  const std::size_t lanes_;
};

}  // namespace

bool PairClusters::build(const PairSearch& search, const SourceGroup& targets,
                         const SearchCoordinates& places, std::span<const SourceGroup> groups,
                         TaskRunner* runner) {
  VAT_CHECK(search.reach > 0 && targets.grid != nullptr);
  const CandidateSearch candidates(search, places, groups);
  const std::size_t slots = targets.grid->order().size();
  chunks_.resize(block_count(slots, kChunkSize));
  std::atomic<std::size_t> work = 0;
  for_blocks<kChunkSize>(runner, slots, [&](std::size_t begin, std::size_t end) {
    Chunk& chunk = chunks_[begin / kChunkSize];
    chunk.clusters.clear();
    collect_targets(targets, begin, end, chunk.clusters);
    std::size_t count = 0;
    std::size_t own_work = 0;
    for (TargetCluster& cluster : chunk.clusters) {
      if (work.load(std::memory_order_relaxed) + own_work > search.most_work) break;
      count = candidates.find(cluster, chunk.candidates, count);
      own_work += std::size_t{cluster.size()} * cluster.candidate_count;
    }
    work.fetch_add(own_work, std::memory_order_relaxed);
  });
  return work.load() <= search.most_work;
}

}  // namespace vat
