#include "core/liquid/pairs/pair_clusters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/distance.h"
#include "tests/support/thread_runner.h"

// Clusters of targets and their candidates, compared with a search over all pairs.

namespace vat::test::pair_clusters_test {
namespace {

using Points = std::vector<Vec3>;

/// Two groups of sources. The targets are the first group.
class Cloud {
 public:
  Cloud(Points first, Points second, Real cell_size) {
    for (Points* points : {&first, &second}) {
      UniformGrid& grid = grids_[points == &first ? 0 : 1];
      grid.build(*points, cell_size);
      for (const Index i : grid.order()) places.push_back((*points)[i]);
    }
    groups = {SourceGroup{&grids_[0], 0},
              SourceGroup{&grids_[1], static_cast<Index>(first.size())}};
    search.origin = grids_[0].origin();
    for (std::size_t n = 0; n < places.size() + 16; ++n) {
      const Vec3 p = n < places.size() ? Vec3(places[n] - search.origin) : Vec3::Zero();
      search.x.push_back(static_cast<float>(p.x()));
      search.y.push_back(static_cast<float>(p.y()));
      search.z.push_back(static_cast<float>(p.z()));
    }
  }

  PairSearch how(Real reach, InstructionSet set) const {
    PairSearch how;
    how.reach = reach;
    how.padding = static_cast<Index>(places.size());
    how.first_mirrored = groups[1].first;
    how.most_work = 1'000'000'000;
    how.instructions = set;
    return how;
  }

  Points places;  ///< indexed by source
  SearchCoordinates search;
  std::array<SourceGroup, 2> groups;

 private:
  std::array<UniformGrid, 2> grids_;
};

Points random_points(std::size_t count, Real size, unsigned seed) {
  std::mt19937 generator(seed);
  const auto number = [&] { return size * (static_cast<Real>(generator()) / 4294967295.0 - 0.5); };
  Points points(count);
  for (Vec3& p : points) p = {number(), number(), number()};
  return points;
}

/// Distributions that are difficult for a search: uniform, clumped, coincident, on a line, and two
/// distant groups.
std::vector<Points> difficult_points() {
  std::vector<Points> all = {random_points(700, 1, 1), random_points(60, 0.01, 2), {}, {{1, 2, 3}}};
  all.push_back(Points(40, Vec3(0.5, 0.5, 0.5)));
  Points line;
  for (int i = 0; i < 300; ++i) line.emplace_back(0.01 * i, 0, 0);
  all.push_back(line);
  Points apart = random_points(100, 0.3, 3);
  for (std::size_t i = 0; i < 50; ++i) apart[i] += Vec3(1000, -1000, 500);
  all.push_back(apart);
  return all;
}

void expect_all_pairs(const Cloud& cloud, Real reach, InstructionSet set, TaskRunner* runner) {
  const PairSearch how = cloud.how(reach, set);
  PairClusters clusters;
  ASSERT_TRUE(clusters.build(how, cloud.groups[0], cloud.search, cloud.groups, runner));
  const Index targets = cloud.groups[1].first;
  std::vector<int> seen(targets, 0);
  clusters.for_each_chunk(nullptr, {}, [&](const PairInputs& in, auto chunk) {
    for (const TargetCluster& cluster : chunk) {
      ASSERT_LE(cluster.size(), kMaxTargets);
      ASSERT_EQ(cluster.candidate_count % lane_count(set), 0U);
      std::vector<Index> candidates(
          in.candidates + cluster.first_candidate,
          in.candidates + cluster.first_candidate + cluster.candidate_count);
      std::erase(candidates, how.padding);
      EXPECT_TRUE(std::ranges::is_sorted(candidates));
      EXPECT_TRUE(std::ranges::adjacent_find(candidates) == candidates.end());
      const bool has_mirrored = !candidates.empty() && candidates.back() >= how.first_mirrored;
      EXPECT_EQ(cluster.has_mirrored, has_mirrored);
      for (Index i = cluster.begin; i < cluster.end; ++i) {
        ++seen[i];
        for (Index j = 0; j < cloud.places.size(); ++j) {
          if (distance_between(cloud.places[i], cloud.places[j]) >= reach) continue;
          EXPECT_TRUE(std::ranges::binary_search(candidates, j)) << i << " and " << j;
        }
      }
    }
  });
  EXPECT_TRUE(std::ranges::all_of(seen, [](int times) { return times == 1; }));
}

TEST(PairClusters, HaveEveryPairOnce) {
  ThreadRunner runner(4);
  const std::vector<Points> points = difficult_points();
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Cloud cloud(points[p], random_points(200, 1.2, 9), 0.1);
    for (const InstructionSet set : available_instruction_sets()) {
      for (const Real reach : {0.04, 0.1, 0.27}) {
        SCOPED_TRACE(testing::Message() << p << ' ' << to_string(set) << ' ' << reach);
        expect_all_pairs(cloud, reach, set, nullptr);
        expect_all_pairs(cloud, reach, set, &runner);
      }
    }
  }
}

// The search omits distant sources, so only few candidates are superfluous.
TEST(PairClusters, OmitDistantParticles) {
  const Cloud cloud(random_points(8000, 1, 5), {}, 0.1);
  const Real reach = 0.1;
  for (const InstructionSet set : available_instruction_sets()) {
    PairClusters clusters;
    const PairSearch how = cloud.how(reach, set);
    ASSERT_TRUE(clusters.build(how, cloud.groups[0], cloud.search, cloud.groups, nullptr));
    std::size_t tried = 0;
    std::size_t pairs = 0;
    clusters.for_each_chunk(nullptr, {}, [&](const PairInputs& in, auto chunk) {
      for (const TargetCluster& cluster : chunk) {
        for (Index i = cluster.begin; i < cluster.end; ++i) {
          for (Index k = 0; k < cluster.candidate_count; ++k) {
            const Index j = in.candidates[cluster.first_candidate + k];
            ++tried;
            if (j == how.padding) continue;
            pairs += (cloud.places[i] - cloud.places[j]).norm() < reach;
          }
        }
      }
    });
    // A sphere of that radius fills a fraction (4/3 pi) / (1 + 6 + 3 pi + 4/3 pi) of a cube of the
    // same width with rounded edges. Padding reduces the fraction.
    EXPECT_GT(static_cast<Real>(pairs), 0.17 * static_cast<Real>(tried)) << to_string(set);
  }
}

TEST(PairClusters, StopAtTheLimitOfWork) {
  const Cloud cloud(Points(3000, Vec3::Zero()), {}, 0.1);
  PairSearch how = cloud.how(0.1, best_instruction_set());
  how.most_work = 1'000'000;
  PairClusters clusters;
  EXPECT_FALSE(clusters.build(how, cloud.groups[0], cloud.search, cloud.groups, nullptr));
  std::size_t work = 0;
  clusters.for_each_chunk(nullptr, {}, [&](const PairInputs&, auto chunk) {
    for (const TargetCluster& cluster : chunk) {
      work += std::size_t{cluster.size()} * cluster.candidate_count;
    }
  });
  EXPECT_LT(work, 1'100'000U);
  how.most_work = 10'000'000;
  EXPECT_TRUE(clusters.build(how, cloud.groups[0], cloud.search, cloud.groups, nullptr));
}

/// Writes the index and the viscosity of each target.
void tell_targets(const PairInputs& in, std::span<const TargetCluster> clusters, Real* sums) {
  for (const TargetCluster& cluster : clusters) {
    for (Index i = cluster.begin; i < cluster.end; ++i) {
      Real* const out = sums + 2 * (i - in.first_target);
      out[0] = static_cast<Real>(i);
      out[1] = in.target_viscosities[i - in.first_target];
    }
  }
}

// Some cells contain many targets.
TEST(PairClusters, GiveEachTargetItsOwnSums) {
  ThreadRunner runner(4);
  Points points = random_points(2000, 1, 4);
  points.insert(points.end(), 1000, Vec3::Zero());
  // The targets follow other sources, as solids do.
  const Cloud cloud(random_points(30, 1, 5), points, 0.1);
  PairClusters clusters;
  const PairSearch how = cloud.how(0.1, best_instruction_set());
  ASSERT_TRUE(clusters.build(how, cloud.groups[1], cloud.search, cloud.groups, &runner));
  std::vector<Real> viscosities;
  for (Index i = 30; i < cloud.places.size(); ++i) viscosities.push_back(2 * i);
  PairInputs inputs;
  inputs.first_target = 30;
  inputs.target_viscosities = viscosities.data();
  std::vector<int> seen(cloud.places.size(), 0);
  clusters.for_each_sum<2>(&runner, inputs, &tell_targets,
                           [&](const TargetCluster& cluster, Index i, const Real* sums) {
                             ++seen[i];
                             EXPECT_TRUE(i >= cluster.begin && i < cluster.end);
                             EXPECT_EQ(sums[0], static_cast<Real>(i));
                             EXPECT_EQ(sums[1], static_cast<Real>(2 * i));
                           });
  for (Index i = 0; i < seen.size(); ++i) ASSERT_EQ(seen[i], i < 30 ? 0 : 1);
}

}  // namespace
}  // namespace vat::test::pair_clusters_test
