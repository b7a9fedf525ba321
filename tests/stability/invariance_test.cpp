#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/stability/builders.h"
#include "tests/stability/transform.h"
#include "tests/support/name_of.h"

// A transformed scene gives the transformed result, up to round-off.

namespace vat::stability::invariance_test {
namespace {

/// Two bodies of every kind in a heap, so that every pairing is in contact. They are off the
/// lattice, so that no particle is at a cutoff.
Scene make_heap(IntegratorId integrator) {
  Scene scene = make_scene();
  scene.gravity = {0.3, -0.2, -9.81};
  scene.default_interface = {500, 1};
  scene.numerics = {integrator, 5e-4, 5e-4};
  int n = 0;
  for (const BodyKind kind : kKinds) {
    for (int twin = 0; twin < 2; ++twin) {
      BodyDescription body = make_block("body " + std::to_string(n), kind, 3,
                                        {0.031 + 0.121 * twin, 0.117 * n / 2, 0.4 + 0.013 * n});
      if (kind == BodyKind::liquid && twin == 1) body.material = "oil";
      body.velocity = {0.3 - 0.6 * twin, 0.5 - 0.2 * n, 0.1 * n};
      if (kind != BodyKind::liquid) body.angular_velocity = {1, -2, 3};
      auto& shape = std::get<ParticleShape>(body.shape);
      for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        const auto t = static_cast<Real>(i + 27 * static_cast<std::size_t>(n));
        shape.positions[i] += 0.004 * Vec3(std::sin(7 * t), std::sin(11 * t), std::sin(13 * t));
      }
      scene.bodies.push_back(body);
      ++n;
    }
  }
  return scene;
}

Scene make_heap_in_vat(IntegratorId integrator) {
  Scene scene = make_heap(integrator);
  scene.vat =
      Vat{{-0.1, -0.15, 0.29}, {0.4, 0.6, 0.9}, true, SlideMotion{{1, 1, 0}, 0.05, 0.3}, {}};
  return scene;
}

constexpr std::uint32_t kSteps = 200;

/// Returns the expected position of particle `i` of body `b` from its position in the first run.
using Expectation = std::function<Vec3(const Vec3& position, Real time)>;

struct Compared {
  Real apart = 0;           ///< maximum distance from the expected position [m]
  Real contact_energy = 0;  ///< at the end [J]
};

Compared compare(const Scene& scene, const Scene& other, const Expectation& expected,
                 bool in_reverse) {
  Simulation a = test::make_simulation(scene);
  Simulation b = test::make_simulation(other);
  EXPECT_TRUE(a.advance(kSteps).events.empty());
  EXPECT_TRUE(b.advance(kSteps).events.empty());
  Compared result;
  result.contact_energy = a.diagnostics().contact_energy;
  const auto first = a.bodies();
  const auto second = b.bodies();
  for (std::size_t body = 0; body < first.size(); ++body) {
    const auto& positions = first[body].positions;
    const auto& others = second[in_reverse ? first.size() - 1 - body : body].positions;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3 seen = others[in_reverse ? positions.size() - 1 - i : i];
      result.apart = std::max(result.apart, (seen - expected(positions[i], a.time())).norm());
    }
  }
  return result;
}

/// Round-off of 1e-16 at positions up to 10 m. It grows in about ten contacts, and in liquids by up
/// to a factor of three per hundredth of a second.
constexpr Real kRoundOff = 1e-15 * 59049;

class Invariance : public testing::TestWithParam<IntegratorId> {};

TEST_P(Invariance, OfTransformedScenes) {
  const Scene heap = make_heap(GetParam());
  const Scene in_vat = make_heap_in_vat(GetParam());
  const Quat rotation(Eigen::AngleAxis<Real>(1.1, Vec3(1, 2, -0.5).normalized()));
  const Vec3 offset(3.3, -7.1, 5.7);
  const Vec3 velocity(2, -3, 1);
  struct Case {
    const char* name;
    const Scene& scene;
    Scene other;
    Expectation expected;
    bool in_reverse = false;
  };
  const Case cases[] = {
      {"rotation", heap, rotated(heap, rotation),
       [&](const Vec3& x, Real) { return Vec3(rotation * x); }},
      {"translation", in_vat, translated(in_vat, offset),
       [&](const Vec3& x, Real) { return Vec3(x + offset); }},
      {"moving frame", heap, in_moving_frame(heap, velocity),
       [&](const Vec3& x, Real t) { return Vec3(x + t * velocity); }},
      {"mirror image", in_vat, mirrored(in_vat),
       [](const Vec3& x, Real) { return Vec3(-x.x(), x.y(), x.z()); }},
      {"renumbering", in_vat, renumbered(in_vat), [](const Vec3& x, Real) { return x; }, true}};
  for (const Case& one : cases) {
    SCOPED_TRACE(one.name);
    const Compared result = compare(one.scene, one.other, one.expected, one.in_reverse);
    EXPECT_GT(result.contact_energy, 1e-3);
    EXPECT_LT(result.apart, kRoundOff);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Invariance, testing::ValuesIn(test::kIntegrators), test::NameOf());

}  // namespace
}  // namespace vat::stability::invariance_test
