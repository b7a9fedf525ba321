#include "protocol/frame/frame_domain.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace vat::test::frame_domain_test {
namespace {

constexpr Real kSteps = 65'535;

PublishedState make_state(std::vector<Vec3> positions) {
  PublishedState state;
  PublishedState::Body& body = state.bodies.emplace_back();
  body.id = 1;
  body.positions = std::move(positions);
  return state;
}

Vat make_vat() {
  Vat vat;
  vat.min = Vec3(-1, 0, 0);
  vat.max = Vec3(1, 1, 0.5);
  return vat;
}

/// Returns whether the grid covers all positions. Tests of grids show that their error is then at
/// most half the quantum.
bool covers(const FrameGrid& grid, const PublishedState& state) {
  const Vec3 min(grid.origin[0], grid.origin[1], grid.origin[2]);
  const Vec3 max = min + Vec3::Constant(kSteps * grid.quantum);
  return std::ranges::all_of(state.bodies[0].positions, [&](const Vec3& x) {
    return (x.array() >= min.array()).all() && (x.array() <= max.array()).all();
  });
}

std::vector<Vec3> cloud(const Vec3& center, Real size) {
  std::vector<Vec3> positions;
  for (int i = 0; i < 200; ++i) {
    const Vec3 x(std::fmod(0.618 * i, 1), std::fmod(0.755 * i, 1), std::fmod(0.570 * i, 1));
    positions.push_back(center + size * (x - Vec3::Constant(0.5)));
  }
  return positions;
}

TEST(FrameDomain, TheQuantumIsTwiceTheErrorIfTheVatFits) {
  for (const Real max_error : {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 0.1}) {
    FrameDomain domain(make_vat());
    const PublishedState state = make_state(cloud(Vec3(0, 0.5, 0.25), 0.5));
    domain.include(state);
    EXPECT_TRUE(covers(domain.grid(max_error), state));
    EXPECT_DOUBLE_EQ(domain.grid(max_error).quantum, std::max(2 * max_error, 2 / kSteps))
        << "the vat is 2 m wide";
  }
}

TEST(FrameDomain, CoversTheVatOverItsWholeMotion) {
  Vat vat = make_vat();
  vat.motion = SlideMotion{Vec3(3, 0, 4), 10, 1};  // 6 m along x, 8 m along z
  const FrameGrid grid = FrameDomain(vat).grid(0);
  EXPECT_EQ(grid.origin, (std::array<double, 3>{-1, 0, 0}));
  EXPECT_DOUBLE_EQ(grid.quantum, 8.5 / kSteps);
}

TEST(FrameDomain, CenteredGridHasTheBoxInItsMiddle) {
  FrameDomain domain(make_vat());
  const FrameGrid grid = domain.centered_grid(1e-3);
  EXPECT_EQ(grid.quantum, domain.grid(1e-3).quantum);
  const Vec3 origin(grid.origin[0], grid.origin[1], grid.origin[2]);
  const Vec3 middle = origin + Vec3::Constant(kSteps * grid.quantum / 2);
  EXPECT_LE((middle - Vec3(0, 0.5, 0.25)).cwiseAbs().maxCoeff(), grid.quantum);
  EXPECT_EQ(domain.centered_grid(0).origin[0], domain.grid(0).origin[0]) << "no range is left";
}

TEST(FrameDomain, SmallMovesKeepTheGrid) {
  FrameDomain domain;
  domain.include(make_state(cloud(Vec3::Zero(), 1)));
  const FrameGrid before = domain.grid(0);
  domain.include(make_state(cloud(Vec3(0.1, -0.1, 0.2), 1)));
  domain.include(make_state(cloud(Vec3(0, 0, 0), 0.9)));
  EXPECT_EQ(domain.grid(0).origin, before.origin);
  EXPECT_EQ(domain.grid(0).quantum, before.quantum);
}

TEST(FrameDomain, ALongFallDoesNotCoarsenTheGrid) {
  FrameDomain domain;
  for (int i = 0; i < 1000; ++i) {
    const PublishedState state = make_state(cloud(Vec3(0, 0, -i), 1));
    domain.include(state);
    EXPECT_LE(domain.grid(0).quantum, 4 / kSteps);
    ASSERT_TRUE(covers(domain.grid(0), state)) << i;
  }
}

TEST(FrameDomain, ADropThatFlewFarIsForgottenWhenItIsBack) {
  FrameDomain domain(make_vat());
  std::vector<Vec3> positions = cloud(Vec3(0, 0.5, 0.25), 0.5);
  positions.emplace_back(0, 0, 190);
  domain.include(make_state(positions));
  EXPECT_GE(domain.grid(0).quantum, 190 / kSteps);
  EXPECT_TRUE(covers(domain.grid(0), make_state(positions)));
  positions.back() = Vec3(0, 0, 0.5);
  domain.include(make_state(positions));
  EXPECT_LE(domain.grid(0).quantum, 1.5 * 2 / kSteps * (1 + 1e-12));
}

TEST(FrameDomain, WithoutAnythingToCoverTheGridIsStillOne) {
  FrameDomain domain;
  domain.include(PublishedState{});
  const FrameGrid grid = domain.grid(0);
  EXPECT_GT(grid.quantum, 0);
  EXPECT_TRUE(std::isfinite(grid.quantum));

  const PublishedState one = make_state({Vec3(1e5, -3, 2)});
  domain.include(one);
  EXPECT_LE(domain.grid(0).quantum, 2e-11);
  EXPECT_TRUE(covers(domain.grid(0), one) && covers(domain.grid(1e-3), one));
}

}  // namespace
}  // namespace vat::test::frame_domain_test
