#include "protocol/frame/frame_domain.h"

#include <gtest/gtest.h>

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

/// The largest error per axis of the positions that a client decodes, and the header's quantum.
struct Sent {
  Real error = 0;
  Real quantum = 0;
  std::vector<Vec3> positions;
};
Sent send(const PublishedState& state, const FrameGrid& grid) {
  GridFrame frame;
  make_grid_frame(state, {grid, {}}, frame);
  Sent sent;
  sent.quantum = frame.scale.grid.quantum;
  const Vec3 origin(frame.scale.grid.origin[0], frame.scale.grid.origin[1],
                    frame.scale.grid.origin[2]);
  const auto& grid_positions = frame.blocks.at(0).positions;
  for (std::size_t i = 0; i < state.bodies[0].positions.size(); ++i) {
    const Vec3 steps(grid_positions[3 * i], grid_positions[3 * i + 1], grid_positions[3 * i + 2]);
    sent.positions.push_back(origin + sent.quantum * steps);
    const Vec3 difference = sent.positions.back() - state.bodies[0].positions[i];
    sent.error = std::max(sent.error, difference.cwiseAbs().maxCoeff());
  }
  return sent;
}

/// Returns the rounding error of origin + quantum * steps, in addition to the error that the
/// protocol guarantees.
Real rounding(const Sent& sent) {
  Real greatest = 0;
  for (const Vec3& x : sent.positions) greatest = std::max(greatest, x.cwiseAbs().maxCoeff());
  return 4 * std::numeric_limits<Real>::epsilon() * (greatest + kSteps * sent.quantum);
}

std::vector<Vec3> cloud(const Vec3& center, Real size) {
  std::vector<Vec3> positions;
  for (int i = 0; i < 200; ++i) {
    const Vec3 x(std::fmod(0.618 * i, 1), std::fmod(0.755 * i, 1), std::fmod(0.570 * i, 1));
    positions.push_back(center + size * (x - Vec3::Constant(0.5)));
  }
  return positions;
}

TEST(FrameDomain, TheErrorIsAtMostHalfTheQuantum) {
  for (const Real max_error : {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 0.1}) {
    FrameDomain domain(make_vat());
    const PublishedState state = make_state(cloud(Vec3(0, 0.5, 0.25), 0.5));
    domain.include(state);
    const Sent sent = send(state, domain.grid(max_error));
    EXPECT_LE(sent.error, sent.quantum / 2 + rounding(sent));
    EXPECT_GT(sent.error, 0);
    EXPECT_DOUBLE_EQ(sent.quantum, std::max(2 * max_error, 2 / kSteps)) << "the vat is 2 m wide";
  }
}

TEST(FrameDomain, CoversTheVatOverItsWholeMotion) {
  Vat vat = make_vat();
  vat.motion = SlideMotion{Vec3(3, 0, 4), 10, 1};  // 6 m along x, 8 m along z
  const FrameGrid grid = FrameDomain(vat).grid(0);
  EXPECT_EQ(grid.origin, (std::array<double, 3>{-1, 0, 0}));
  EXPECT_DOUBLE_EQ(grid.quantum, 8.5 / kSteps);
}

TEST(FrameDomain, ParticlesBeyondTheVatAreCoveredToo) {
  FrameDomain domain(make_vat());
  const PublishedState state = make_state({Vec3(0, 0.5, 0.1), Vec3(0, -0.2, 7)});
  domain.include(state);
  const Sent sent = send(state, domain.grid(1e-4));
  EXPECT_LE(sent.error, 1e-4 + rounding(sent));
}

// A grid that does not cover a particle moves it to the nearest position inside. make_frame_grid
// accepts any grid.
TEST(FrameDomain, APositionOutsideAGridIsMovedToTheNearestInside) {
  const PublishedState state = make_state({Vec3(-5, 0.5, 9), Vec3(0.25, 0.5, 0.75)});
  const Sent sent = send(state, make_frame_grid(Vec3::Zero(), Vec3::Ones(), 0));
  EXPECT_NEAR((sent.positions[0] - Vec3(0, 0.5, 1)).cwiseAbs().maxCoeff(), 0, 0.5 / kSteps + 1e-12);
  EXPECT_NEAR((sent.positions[1] - Vec3(0.25, 0.5, 0.75)).cwiseAbs().maxCoeff(), 0,
              0.5 / kSteps + 1e-12);
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
    const Sent sent = send(state, domain.grid(0));
    EXPECT_LE(sent.quantum, 4 / kSteps);
    EXPECT_LE(sent.error, sent.quantum / 2 + rounding(sent));
  }
}

TEST(FrameDomain, ADropThatFlewFarIsForgottenWhenItIsBack) {
  FrameDomain domain(make_vat());
  std::vector<Vec3> positions = cloud(Vec3(0, 0.5, 0.25), 0.5);
  positions.emplace_back(0, 0, 190);
  domain.include(make_state(positions));
  EXPECT_GE(domain.grid(0).quantum, 190 / kSteps);
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
  EXPECT_LE(send(one, domain.grid(0)).error, 1e-11);
  EXPECT_LE(send(one, domain.grid(1e-3)).error, 1e-3);
}

}  // namespace
}  // namespace vat::test::frame_domain_test
