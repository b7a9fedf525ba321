#include "protocol/frame/grid_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace vat::grid_frame_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(FrameGrid, TakesTwiceTheErrorIfTheDomainFits) {
  const FrameGrid grid = make_frame_grid({-1, 2, 0}, {3, 3, 1}, 1e-3);
  EXPECT_EQ(grid.quantum, 2e-3);
  EXPECT_EQ(grid.origin, (std::array<double, 3>{-1, 2, 0}));
}

TEST(FrameGrid, IsCoarserIfTheDomainDoesNotFit) {
  for (const double max_error : {1e-9, 0.0, -1.0, std::nan(""), kInfinity}) {
    const FrameGrid grid = make_frame_grid({-1, 2, 0}, {3, 3, 1}, max_error);
    EXPECT_EQ(grid.quantum, 4.0 / 65535) << max_error;
  }
}

TEST(FrameGrid, OfAnEmptyDomainHasAQuantumAboveZero) {
  EXPECT_GT(make_frame_grid({1, 1, 1}, {1, 1, 1}, 0).quantum, 0);
  EXPECT_GT(make_frame_grid({1, 1, 1}, {0, 0, 0}, 0).quantum, 0);
}

PublishedState liquid_state(std::vector<Vec3> positions) {
  PublishedState state;
  PublishedState::Body& body = state.bodies.emplace_back();
  body.id = 1;
  body.positions = std::move(positions);
  return state;
}

GridFrame on_grid(const PublishedState& state, const FrameGrid& grid) {
  GridFrame frame;
  make_grid_frame(state, {grid, {}}, frame);
  return frame;
}

/// Returns half a quantum, plus the rounding of origin + quantum * integer in double precision.
double allowed_error(const FrameGrid& grid, const Vec3& min, const Vec3& max) {
  const double greatest = std::max(min.cwiseAbs().maxCoeff(), max.cwiseAbs().maxCoeff());
  return grid.quantum / 2 + 4 * std::numeric_limits<double>::epsilon() * greatest;
}

TEST(GridFrame, HasPositionsWithinHalfAQuantum) {
  const std::vector<std::pair<Vec3, Vec3>> domains{{{0, 0, 0}, {1, 0.6, 0.6}},
                                                   {{-5, 3, -0.1}, {-4, 300, 0.1}},
                                                   {{-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6}},
                                                   {{1e6 - 1e-3, 0, 0}, {1e6, 1e-3, 1e-3}}};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (const auto& [min, max] : domains) {
    for (const double max_error : {0.0, 1e-4, 0.05}) {
      const FrameGrid grid = make_frame_grid(min, max, max_error);
      std::vector<Vec3> positions{min, max};
      for (int i = 0; i < 500; ++i) {
        const Vec3 part(unit(random), unit(random), unit(random));
        positions.emplace_back(min + part.cwiseProduct(max - min));
      }
      const std::vector<std::uint16_t> steps =
          on_grid(liquid_state(positions), grid).blocks[0].positions;
      ASSERT_EQ(steps.size(), 3 * positions.size());
      for (std::size_t i = 0; i < steps.size(); ++i) {
        const double value = grid.origin[i % 3] + grid.quantum * steps[i];
        const double sent = positions[i / 3][static_cast<Eigen::Index>(i % 3)];
        ASSERT_LE(std::abs(value - sent), allowed_error(grid, min, max));
      }
    }
  }
}

TEST(GridFrame, MovesOutsideParticlesToTheEdge) {
  const double nan = std::nan("");
  const PublishedState state = liquid_state({{-1, 5, nan}, {-kInfinity, kInfinity, 1e300}});
  EXPECT_EQ(on_grid(state, make_frame_grid({0, 0, 0}, {1, 1, 1}, 0)).blocks[0].positions,
            (std::vector<std::uint16_t>{0, 65535, 0, 0, 65535, 65535}));
}

// Every particle of a rigid body is at the position given by its pose, within the error of liquid
// particles.
TEST(GridFrame, HasPosesThatKeepEveryParticleWithinTheError) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double radius : {0.0, 0.01, 0.1, 5.0}) {
    for (const double max_error : {1e-2, 1e-4}) {
      const FrameGrid grid = make_frame_grid({-1, -1, -1}, {1, 1, 1}, max_error);
      for (int i = 0; i < 300; ++i) {
        const Quat turn = Quat(unit(random), unit(random), unit(random), unit(random)).normalized();
        const Vec3 center(unit(random), unit(random), unit(random));
        PublishedState state;
        PublishedState::Body& body = state.bodies.emplace_back();
        body.id = 1;
        body.kind = BodyKind::rigid;
        body.center_of_mass = {center.x(), center.y(), center.z()};
        body.orientation = {turn.w(), turn.x(), turn.y(), turn.z()};
        body.bounding_radius = radius;
        const GridFrame frame = on_grid(state, grid);
        const auto [x, y, z] = place_of(frame, frame.blocks[0]);
        const auto [w, a, b, c] = orientation_of(frame.blocks[0]);
        const Vec3 arm = radius * Vec3(unit(random), unit(random), unit(random)).normalized();
        const Vec3 sent = Vec3(x, y, z) + Quat(w, a, b, c) * arm;
        ASSERT_LE((sent - (center + turn * arm)).cwiseAbs().maxCoeff(), grid.quantum / 2 + 1e-12);
      }
    }
  }
}

TEST(GridFrame, LayersHaveTheirShares) {
  std::array<int, 4> counts{};
  constexpr int kCount = 100'000;
  for (std::uint32_t number = 0; number < kCount; ++number) ++counts[detail_layer(number)];
  const std::array<double, 4> shares{0.125, 0.125, 0.25, 0.5};
  for (std::size_t layer = 0; layer < 4; ++layer) {
    const double deviation = std::sqrt(shares[layer] * (1 - shares[layer]) / kCount);
    EXPECT_NEAR(counts[layer] / double{kCount}, shares[layer], 5 * deviation);
  }
}

TEST(GridFrame, ALevelOfDetailIsASelection) {
  PublishedState state = liquid_state({});
  PublishedState::Body& body = state.bodies[0];
  for (std::uint32_t i = 0; i < 300; ++i) {
    body.positions.emplace_back(i % 10, i / 10 % 10, i / 100);
    body.numbers.push_back(2 * i + 1);
    body.attributes[0].push_back(static_cast<float>(i));
  }
  FrameScale scale{make_frame_grid({0, 0, 0}, {9, 9, 9}, 0.01), {}};
  scale.attribute_quanta[0] = 0.1;
  GridFrame all;
  make_grid_frame(state, scale, all);
  for (std::uint8_t detail = 0; detail <= kFullDetail; ++detail) {
    GridFrame part;
    GridFrame selected;
    make_grid_frame(state, scale, detail, part);
    select_particles(all, {detail, {}}, selected);
    EXPECT_TRUE(show_the_same(part, selected)) << int{detail};
    EXPECT_EQ(part.blocks[0].particle_count(), part.blocks[0].attributes[0].size());
  }
}

TEST(GridFrame, ASelectionHasItsParticlesAlone) {
  std::vector<Vec3> positions;
  for (int i = 0; i < 1000; ++i) positions.emplace_back(i % 10, i / 10 % 10, i / 100);
  PublishedState state = liquid_state(positions);
  const GridFrame all = on_grid(state, make_frame_grid({0, 0, 0}, {9, 9, 9}, 0.01));
  const FrameSelection selection{1, FrameRegion{{2, 0, 0}, {5, 9, 4}}};
  GridFrame part;
  select_particles(all, selection, part);
  const GridBlock& block = part.blocks[0];
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    if (detail_layer(i) <= 1 && i % 10 >= 2 && i % 10 <= 5 && i / 100 <= 4) expected.push_back(i);
  }
  EXPECT_EQ(block.numbers, expected);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(block.positions[3 * i], all.blocks[0].positions[3 * expected[i]]);
  }
  EXPECT_EQ(part.detail, 1);
  EXPECT_TRUE(part.has_region);
  EXPECT_FALSE(show_the_same(all, part));
}

}  // namespace
}  // namespace vat::grid_frame_test
