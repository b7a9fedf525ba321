#include "core/liquid/pairs/pair_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/kernels/smoothing_kernel.h"

// Compares every sum, with every instruction set, with plain sums in double precision.

namespace vat::pair_sums_test {
namespace {

constexpr Real kSupport = 0.3;
constexpr Index kTargets = 11;
constexpr Index kSources = 700;  // more than a tile
constexpr Index kMirrored = 501;

/// One cluster of targets (the first sources), among sources within and beyond its reach.
struct Pairs {
  std::vector<PairPlace> places;
  std::vector<PairMotion> motions;
  PositionGrid grid{{4, -1, -1}, 2};
  std::vector<PackedPlace> packed_places;
  std::vector<PackedMotion> packed_motions;
  std::vector<PairViscosity> viscosities;
  std::vector<Real> target_viscosities;
  std::vector<Index> candidates;
  TargetCluster cluster;
  Index dragging = std::numeric_limits<Index>::max();

  Pairs() {
    std::mt19937 generator(3);
    const auto number = [&] { return static_cast<Real>(generator()) / 4294967295.0 - 0.5; };
    for (Index n = 0; n < kSources; ++n) {
      const Real size = n < kTargets ? 0.2 : 0.9;
      places.push_back({5 + size * number(), size * number(), size * number(), 0.6 + number()});
      motions.push_back({number() + 0.4, number(), number(), number()});
      viscosities.push_back({number() + 0.6, n % 2 == 0 ? 1.0 : 0.0, 0.7 + number()});
      candidates.push_back(n);
    }
    places[kTargets] = places[0];  // two coincident particles
    for (Index i = 0; i < kTargets; ++i) target_viscosities.push_back(0.6 + number());
    places.push_back({1e6, 1e6, 1e6, 0});
    motions.push_back({});
    viscosities.push_back({0, 0, 1});
    while (candidates.size() % 16 != 0) candidates.push_back(kSources);
    pack();
    cluster.center = {5, 0, 0};
    cluster.end = kTargets;
    cluster.candidate_count = static_cast<Index>(candidates.size());
    cluster.mirrored_begin = kMirrored;
    cluster.has_mirrored = true;
  }

  void pack() {
    for (std::size_t n = 0; n <= kSources; ++n) {
      const PairPlace& p = places[n];
      const PairMotion& m = motions[n];
      const auto single = [](Real value) { return static_cast<float>(value); };
      packed_places.push_back({grid.coordinate(p.x, 0), grid.coordinate(p.y, 1),
                               grid.coordinate(p.z, 2), single(p.weight)});
      packed_motions.push_back({single(m.pressure), single(m.vx), single(m.vy), single(m.vz)});
    }
    packed_places.back() = {PositionGrid::kFar, PositionGrid::kFar, PositionGrid::kFar, 0};
  }

  PairInputs inputs(bool mixed) const {
    PairInputs in;
    in.places = places.data();
    in.motions = motions.data();
    in.packed_places = packed_places.data();
    in.packed_motions = packed_motions.data();
    in.grid = grid;
    in.inverse_support = 1 / kSupport;
    in.viscosity = 0.8;
    in.first_mirrored = kMirrored;
    in.first_dragging = dragging;
    in.candidates = candidates.data();
    if (mixed) {
      in.viscosities = viscosities.data();
      in.target_viscosities = target_viscosities.data();
    }
    return in;
  }
};

/// The quantities of a pair that the terms of a sum use, in double precision.
struct Pair {
  Index i;
  Index j;
  Vec3 x;  ///< divided by the support radius
  Real q;
  Real w;
  Real g;
  Vec3 v;
};

/// Sums, and sums of absolute values for tolerances.
struct Expected {
  std::vector<Real> sums;
  std::vector<Real> sizes;
};

/// Sums term(pair, add(entry, value)) over all pairs within the support radius.
template <class Term>
Expected add_up(const Pairs& pairs, KernelId id, std::size_t entries, Term&& term) {
  const SmoothingKernel kernel(id, 1, 3);
  Expected expected{std::vector<Real>(entries * kTargets), std::vector<Real>(entries * kTargets)};
  for (Index i = 0; i < kTargets; ++i) {
    for (Index j = 0; j < kSources; ++j) {
      const PairPlace& a = pairs.places[i];
      const PairPlace& b = pairs.places[j];
      const Vec3 x = Vec3(a.x - b.x, a.y - b.y, a.z - b.z) / kSupport;
      const Real q = x.norm();
      if (q >= 1) continue;
      const PairMotion& p = pairs.motions[i];
      const PairMotion& r = pairs.motions[j];
      const Pair pair{i,
                      j,
                      x,
                      q,
                      kernel.value(q) / kernel.scale(),
                      kernel.slope_over_r(q) / kernel.slope_scale(),
                      Vec3(p.vx - r.vx, p.vy - r.vy, p.vz - r.vz)};
      term(pair, [&](int entry, Real value) {
        const std::size_t k = i * entries + static_cast<std::size_t>(entry);
        expected.sums[k] += value;
        expected.sizes[k] += std::abs(value);
      });
    }
  }
  return expected;
}

/// Calls f(table, epsilon of the precision, name) for all tables.
template <class F>
void for_each_table(KernelId kernel, F&& f) {
  for (const auto& [precision, epsilon] :
       {std::pair(PairPrecision::single_precision, std::ldexp(1.0, -24)),
        std::pair(PairPrecision::double_precision, std::ldexp(1.0, -53))}) {
    for (const InstructionSet set : available_instruction_sets()) {
      SCOPED_TRACE(testing::Message() << to_string(set) << ' ' << epsilon);
      f(pair_sums(set, precision, kernel), epsilon);
    }
    SCOPED_TRACE("without vectors");
    f(pair_sums_without_vectors(precision, kernel), epsilon);
  }
}

/// A term has about twenty roundings, including its cancelling parts. The sum has one for each
/// vector of sources.
void expect_sums(const Pairs& pairs, PairSums::Function function, bool mixed,
                 const Expected& expected, Real epsilon) {
  std::vector<Real> sums(expected.sums.size(), -1);
  function(pairs.inputs(mixed), {&pairs.cluster, 1}, sums.data());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    const Real tolerance = epsilon * (200 * expected.sizes[k] + 1);
    EXPECT_NEAR(sums[k], expected.sums[k], tolerance) << k;
  }
}

Real softened(const Pair& pair) {
  return pair.q * pair.q + 0.01 / 4;
}

class PairSumsOf : public testing::TestWithParam<KernelId> {
 protected:
  /// Compares the sum of every table with the terms of all pairs.
  template <class Term>
  static void expect(PairSums::Function PairSums::*function, const Pairs& pairs, bool mixed,
                     std::size_t entries, Term&& term) {
    const Expected expected = add_up(pairs, GetParam(), entries, term);
    for_each_table(GetParam(), [&](const PairSums& table, Real epsilon) {
      expect_sums(pairs, table.*function, mixed, expected, epsilon);
    });
  }

  const Pairs pairs_;
};
INSTANTIATE_TEST_SUITE_P(Kernels, PairSumsOf,
                         testing::Values(KernelId::wendland_c2, KernelId::cubic_spline));

TEST_P(PairSumsOf, DensityIsThatOfAllSources) {
  expect(&PairSums::density, pairs_, false, 1,
         [&](const Pair& p, auto add) { add(0, pairs_.places[p.j].weight * p.w); });
}

TEST_P(PairSumsOf, PressureActsAlongPairs) {
  expect(&PairSums::pressure, pairs_, false, 3, [&](const Pair& p, auto add) {
    const Real both = pairs_.motions[p.i].pressure + pairs_.motions[p.j].pressure;
    for (int a = 0; a < 3; ++a) add(a, -pairs_.places[p.j].weight * both * p.g * p.x[a]);
  });
}

TEST_P(PairSumsOf, ForceHasViscosityOfAllButImagesInWalls) {
  for (const bool mixed : {false, true}) {
    expect(&PairSums::force, pairs_, mixed, 3, [&](const Pair& p, auto add) {
      const PairViscosity& other = pairs_.viscosities[p.j];
      const Real own = mixed ? pairs_.target_viscosities[p.i] : 0.8;
      const Real plain = p.j < kMirrored ? own : 0;
      const Real mu = mixed ? own * other.share / (other.own * own + other.resistance) : plain;
      const Real both = pairs_.motions[p.i].pressure + pairs_.motions[p.j].pressure;
      const Real force = mu * p.v.dot(p.x) / softened(p) - both;
      for (int a = 0; a < 3; ++a) add(a, pairs_.places[p.j].weight * force * p.g * p.x[a]);
    });
  }
}

// Images in walls from the index `dragging` on drag. Images before it are those of solids.
TEST_P(PairSumsOf, ForceIncludesDrag) {
  for (const Index dragging : {kMirrored, Index{0}, Index{534}, kSources}) {
    Pairs pairs = pairs_;
    pairs.dragging = std::max(dragging, kMirrored);
    pairs.cluster.mirrored_begin = dragging;
    expect(&PairSums::force, pairs, false, 3, [&](const Pair& p, auto add) {
      const Real both = pairs.motions[p.i].pressure + pairs.motions[p.j].pressure;
      const Real viscous = 0.8 / softened(p);
      const Real central = p.j < kMirrored ? viscous * p.v.dot(p.x) : 0;
      const Real drag = p.j >= pairs.dragging ? viscous : 0;
      for (int a = 0; a < 3; ++a) {
        const Real force = central - both + drag * p.v[a] * p.x[a];
        add(a, pairs.places[p.j].weight * force * p.g * p.x[a]);
      }
    });
  }
}

TEST_P(PairSumsOf, DragIsThatOfImagesInWalls) {
  for (const bool mixed : {false, true}) {
    Pairs pairs = pairs_;
    for (Index j = 0; mixed && j < kMirrored; ++j) pairs.viscosities[j].share = 0;
    expect(&PairSums::drag, pairs, mixed, 3, [&](const Pair& p, auto add) {
      if (p.j < kMirrored) return;
      const PairViscosity& other = pairs.viscosities[p.j];
      const Real own = mixed ? pairs.target_viscosities[p.i] : 0.8;
      const Real mu = mixed ? own * other.share / (other.own * own + other.resistance) : own;
      const Real part = std::max(pairs.motions[p.i].pressure, pairs.motions[p.j].pressure);
      const Real strength = pairs.places[p.j].weight * part * mu * p.g / softened(p);
      for (int a = 0; a < 3; ++a) add(a, strength * p.x[a] * p.x[a] * p.v[a]);
    });
  }
}

TEST_P(PairSumsOf, GradientIsThatOfWeights) {
  expect(&PairSums::gradient, pairs_, false, 3, [&](const Pair& p, auto add) {
    for (int a = 0; a < 3; ++a) add(a, pairs_.places[p.j].weight * p.g * p.x[a]);
  });
}

TEST_P(PairSumsOf, DivergenceIsThatOfMotions) {
  expect(&PairSums::divergence, pairs_, false, 1, [&](const Pair& p, auto add) {
    const PairMotion& m = pairs_.motions[p.j];
    add(0, p.g * Vec3(m.vx, m.vy, m.vz).dot(p.x));
  });
}

TEST_P(PairSumsOf, VolumeHasDensityWithItsSlopes) {
  expect(&PairSums::volume, pairs_, false, kVolumeSums, [&](const Pair& p, auto add) {
    const Real weight = pairs_.places[p.j].weight;
    add(0, weight * p.w);
    for (int a = 0; a < 3; ++a) add(1 + a, weight * p.g * p.x[a]);
    add(4, weight * p.g * p.g * p.q * p.q);
  });
}

TEST_P(PairSumsOf, ResponseHasGradientsAndTheirSquares) {
  expect(&PairSums::response, pairs_, false, kResponseSums, [&](const Pair& p, auto add) {
    const Real weight = pairs_.places[p.j].weight;
    for (int a = 0; a < 3; ++a) add(a, weight * p.g * p.x[a]);
    add(3, weight * pairs_.motions[p.j].pressure * p.g * p.g * p.q * p.q);
    add(4, weight * pairs_.motions[p.j].vx * p.g * p.q);
  });
}

TEST_P(PairSumsOf, MeanHasWeightsAndMoments) {
  expect(&PairSums::mean, pairs_, false, kMeanSums, [&](const Pair& p, auto add) {
    const Real weight = pairs_.places[p.j].weight * p.w;
    for (int a = 0; a < 3; ++a) add(a, weight * pairs_.motions[p.j].vx * p.x[a]);
    add(3, weight);
    add(4, weight * pairs_.motions[p.j].pressure);
  });
}

TEST_P(PairSumsOf, BlendIsTheWeightedVelocity) {
  expect(&PairSums::blend, pairs_, false, 3, [&](const Pair& p, auto add) {
    const PairMotion& motion = pairs_.motions[p.j];
    const Real weight = pairs_.places[p.j].weight * p.w;
    add(0, weight * motion.vx);
    add(1, weight * motion.vy);
    add(2, weight * motion.vz);
  });
}

TEST_P(PairSumsOf, SpreadHasRelativeVelocitiesAndWeights) {
  expect(&PairSums::spread, pairs_, false, kSpreadSums, [&](const Pair& p, auto add) {
    const Real weight = pairs_.places[p.j].weight;
    for (int a = 0; a < 3; ++a) add(0, weight * p.g * p.v[a] * p.x[a]);
    add(1, weight * p.w);
  });
}

TEST(PositionGrid, RoundsToItsUnitAndKeepsToItself) {
  const PositionGrid grid({-3, 2, 5}, 7);
  EXPECT_LE(grid.unit, 2 * 7.0 / PositionGrid::kCount);
  EXPECT_GE(grid.unit, 7.0 / PositionGrid::kCount);
  for (const Real x : {0.0, 0.1, 3.3, 6.999, 7.0}) {
    const PackedPlace packed{grid.coordinate(x - 3, 0), grid.coordinate(x + 2, 1),
                             grid.coordinate(x + 5, 2), 0};
    const Vec3 error = grid.place(packed) - Vec3(x - 3, x + 2, x + 5);
    EXPECT_LE(error.cwiseAbs().maxCoeff(), 0.51 * grid.unit);
  }
  EXPECT_EQ(grid.coordinate(-4, 0), 0);
  EXPECT_EQ(grid.coordinate(1e300, 0), PositionGrid::kCount);
  EXPECT_EQ(grid.coordinate(std::numeric_limits<Real>::quiet_NaN(), 0), 0);
}

TEST(PairSums, OfTheBaselineAreTheSameBitsWithoutVectors) {
  const Pairs pairs;
  for (const PairPrecision precision :
       {PairPrecision::single_precision, PairPrecision::double_precision}) {
    for (const KernelId kernel : {KernelId::wendland_c2, KernelId::cubic_spline}) {
      const PairSums& a = pair_sums(InstructionSet::baseline, precision, kernel);
      const PairSums& b = pair_sums_without_vectors(precision, kernel);
      for (const auto function :
           {&PairSums::density, &PairSums::pressure, &PairSums::force, &PairSums::drag,
            &PairSums::gradient, &PairSums::divergence, &PairSums::volume, &PairSums::response,
            &PairSums::mean, &PairSums::blend, &PairSums::spread}) {
        for (const bool mixed : {false, true}) {
          std::vector<Real> with(kTargets * kMeanSums, 0);
          std::vector<Real> without = with;
          (a.*function)(pairs.inputs(mixed), {&pairs.cluster, 1}, with.data());
          (b.*function)(pairs.inputs(mixed), {&pairs.cluster, 1}, without.data());
          EXPECT_EQ(with, without);
        }
      }
    }
  }
}

}  // namespace
}  // namespace vat::pair_sums_test
