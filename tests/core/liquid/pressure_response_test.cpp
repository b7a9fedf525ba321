#include "core/liquid/incompressible/pressure_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "core/state/rigid_motion.h"
#include "tests/support/force_probe.h"
#include "tests/support/mixed_scenes.h"

// Effects of pressures and motions in one state of a liquid with solids and walls.

namespace vat::test::pressure_response_test {
namespace {

/// A liquid that touches two walls, a floor, a deformable body and a rigid body. All bodies move.
Scene make_pool() {
  Scene scene = make_two_material_scene(IntegratorId::symplectic_euler, 1e-3);
  scene.pressure_solver = PressureSolver::incompressible;
  scene.pair_precision = PairPrecision::double_precision;
  scene.materials[1].density = 700;
  const auto add = [&](const char* name, BodyKind kind, const char* material, const Vec3& center) {
    scene.bodies.push_back(make_block(name, kind, material, 4, center, Vec3(0.1, -0.2, 0.3)));
  };
  add("water", BodyKind::liquid, "a", {0, 0, 0});
  add("oil", BodyKind::liquid, "b", {0.21, 0.01, 0.02});
  add("jelly", BodyKind::deformable, "a", {0.02, 0.2, 0.01});
  add("crate", BodyKind::rigid, "b", {0.1, 0.01, 0.2});
  for (BodyDescription& body : scene.bodies) {
    if (body.kind == BodyKind::rigid) continue;
    body.jitter = 0.1;
    body.seed = 7;
    body.spacing = kBlockSpacing;
  }
  scene.vat = Vat{Vec3(-0.1, -0.11, -0.1), Vec3(1, 1, 1), false, {}};
  return scene;
}

/// Compiles the scene, with the volumes of solids multiplied by `share_of_solids`.
std::shared_ptr<const Model> compile_with(const Scene& scene, Real share_of_solids) {
  Model model = *compile_scene(scene);
  for (std::size_t i = model.liquid_count; i < model.particle_count; ++i) {
    model.rest_volume[i] *= share_of_solids;
  }
  return std::make_shared<const Model>(std::move(model));
}

/// One evaluated configuration, and its pressure response.
class Place {
 public:
  explicit Place(const Scene& scene, bool solids_move = true, Real share_of_solids = 1)
      : model(compile_with(scene, share_of_solids)), state(initial_state(*model)) {
    work.instructions = best_instruction_set();
    evaluate();
    response = std::make_unique<PressureResponse>(force_model, state.now, scratch, solids_move);
  }
  void evaluate() { force_model.evaluate(state.now, 0, state.forces); }
  StepContext context() { return {*model, controls, 0, 0, state.now, state.forces, work, nullptr}; }
  std::size_t count() const { return model->liquid_count; }
  std::vector<Real> volumes() const {
    std::vector<Real> volumes;
    for (const Index i : work.of<LiquidScratch>().liquid.grid.order())
      volumes.push_back(model->rest_volume[i]);
    return volumes;
  }
  /// Returns -V D M^-1 F(pressure).
  std::vector<Real> react(const std::vector<Real>& pressure) {
    std::vector<Real> rate(count());
    response->accelerate(pressure);
    response->compress(rate);
    const std::vector<Real> v = volumes();
    for (std::size_t s = 0; s < rate.size(); ++s) rate[s] *= -v[s];
    return rate;
  }

  std::shared_ptr<const Model> model;
  Controls controls;
  State state;
  Workspace work;
  ForceModel force_model{*model, controls, work};
  ResponseScratch scratch;
  std::unique_ptr<PressureResponse> response;
};

std::vector<Real> random_numbers(std::size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<Real> numbers(count);
  for (Real& number : numbers) number = static_cast<Real>(generator()) / 4294967295.0;
  return numbers;
}

Real dot(const std::vector<Real>& a, const std::vector<Real>& b) {
  Real sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

TEST(PressureResponse, IsSymmetricAndPositive) {
  Scene periodic = make_pool();
  periodic.bodies.resize(2);
  periodic.vat.reset();
  periodic.periodic = Periodicity{{-0.1, -0.1, -0.1}, {0.3, 0.1, 0.1}, {true, false, true}};
  for (const Scene& scene : {make_pool(), periodic}) {
    for (const bool solids_move : {true, false}) {
      Place place(scene, solids_move);
      const std::vector<Real> a = random_numbers(place.count(), 1);
      const std::vector<Real> b = random_numbers(place.count(), 2);
      const std::vector<Real> react_a = place.react(a);
      EXPECT_NEAR(place.response->energy() / dot(a, react_a), 1, 1e-12);
      const std::vector<Real> react_b = place.react(b);
      EXPECT_GT(dot(a, react_a), 0);
      EXPECT_NEAR(dot(a, react_b) / dot(b, react_a), 1, 1e-12);
      std::vector<Real> difference = a;
      for (std::size_t i = 0; i < a.size(); ++i) difference[i] -= b[i];
      EXPECT_GT(dot(difference, place.react(difference)), 0);
    }
  }
}

TEST(PressureResponse, BoundsItsDiagonal) {
  Place place(make_pool());
  std::vector<Real> diagonal(place.count());
  place.response->find_diagonal(diagonal);
  std::vector<Real> one(place.count(), 0);
  for (std::size_t s = 0; s < one.size(); s += 7) {
    one[s] = 1;
    const Real exact = place.react(one)[s];
    one[s] = 0;
    EXPECT_GT(exact, 0);
    // A particle and its images count twice, and pairs of images once.
    EXPECT_GT(diagonal[s], 0.6 * exact) << s;
    EXPECT_LT(diagonal[s], 2 * exact) << s;
  }
}

// ds/dt of the density that the forces use, by finite differences of positions.
TEST(PressureResponse, SeesHowMotionsCompress) {
  constexpr Real kWay = 1e-6;
  const Scene scene = make_pool();
  Place place(scene, true, 0.5);  // solids count twice in the rate
  std::vector<Real> rate(place.count());
  place.response->see_velocities(Vec3::Zero());
  place.response->compress(rate);
  const std::vector<Index> order(place.work.of<LiquidScratch>().liquid.grid.order().begin(),
                                 place.work.of<LiquidScratch>().liquid.grid.order().end());
  std::vector<Real> expected(place.count(), 0);
  for (const Real side : {-1.0, 1.0}) {
    Place moved(scene);
    for (std::size_t i = 0; i < moved.model->free_count; ++i) {
      moved.state.now.position[i] += side * kWay * place.state.now.velocity[i];
    }
    RigidState& crate = moved.state.now.rigid[0];
    crate.center_of_mass +=
        side * kWay * moved.model->rigid_bodies[0].inverse_mass * crate.momentum;
    crate.orientation = rotate_freely(moved.model->rigid_bodies[0], crate.orientation,
                                      crate.angular_momentum, side * kWay);
    moved.evaluate();
    for (std::size_t s = 0; s < order.size(); ++s) {
      const Real rest = moved.model->liquids[moved.model->material[order[s]]]->rest_density;
      expected[s] += side * moved.work.of<LiquidScratch>().density[order[s]] / rest / (2 * kWay);
    }
  }
  for (std::size_t s = 0; s < order.size(); ++s) {
    EXPECT_NEAR(rate[s], expected[s], 1e-6) << s;
  }
}

// The rate of the accelerations is that of the velocities that they lead to.
TEST(PressureResponse, HasTheRateOfItsKick) {
  constexpr Real kTime = 0.01;
  Place place(make_pool());
  const auto rate_of_velocities = [&] {
    std::vector<Real> rate(place.count());
    place.response->see_velocities(Vec3::Zero());
    place.response->compress(rate);
    return rate;
  };
  const std::vector<Real> before = rate_of_velocities();
  std::vector<Real> pressure = random_numbers(place.count(), 3);
  for (Real& p : pressure) p *= 1e4;
  std::vector<Real> expected(place.count());
  place.response->accelerate(pressure);
  place.response->compress(expected);
  place.response->add(1);
  place.response->kick(kTime);
  const std::vector<Real> after = rate_of_velocities();
  const Real greatest =
      std::abs(std::ranges::max(expected, {}, [](Real x) { return std::abs(x); }));
  for (std::size_t s = 0; s < expected.size(); ++s) {
    EXPECT_NEAR((after[s] - before[s]) / kTime, expected[s], 1e-10 * greatest) << s;
  }
}

TEST(PressureResponse, KicksByTheSumOfItsAccelerations) {
  Place parts(make_pool());
  Place whole(make_pool());
  const std::vector<Real> a = random_numbers(parts.count(), 4);
  const std::vector<Real> b = random_numbers(parts.count(), 5);
  std::vector<Real> sum(a.size());
  for (std::size_t s = 0; s < a.size(); ++s) sum[s] = 2 * a[s] - 3 * b[s];
  const auto act = [](Place& place, const std::vector<Real>& pressure, Real share) {
    place.response->accelerate(pressure);
    place.response->add(share);
  };
  act(parts, a, 1);
  act(parts, b, -3);
  act(parts, a, 1);
  act(whole, sum, 1);
  const Configuration before = whole.state.now;
  parts.response->kick(1);
  whole.response->kick(1);
  Real greatest = 0;
  for (std::size_t i = 0; i < before.velocity.size(); ++i) {
    greatest = std::max(greatest, (whole.state.now.velocity[i] - before.velocity[i]).norm());
  }
  EXPECT_GT(greatest, 0);
  for (std::size_t i = 0; i < before.velocity.size(); ++i) {
    const Vec3 difference = parts.state.now.velocity[i] - whole.state.now.velocity[i];
    EXPECT_LT(difference.norm(), 1e-12 * greatest) << i;
  }
  const Vec3 momentum = parts.state.now.rigid[0].momentum - before.rigid[0].momentum;
  const Vec3 expected = whole.state.now.rigid[0].momentum - before.rigid[0].momentum;
  EXPECT_LT((momentum - expected).norm(), 1e-12 * expected.norm());
}

TEST(PressureResponse, KeepsMomentumWithoutWalls) {
  Scene scene = make_pool();
  scene.vat.reset();
  Place place(scene);
  const auto momentum = [&] {
    Vec3 sum = place.state.now.rigid[0].momentum;
    for (Index i = 0; i < place.model->free_count; ++i) {
      sum += place.model->mass[i] * place.state.now.velocity[i];
    }
    return sum;
  };
  const auto angular_momentum = [&] {
    const RigidState& crate = place.state.now.rigid[0];
    Vec3 sum = crate.angular_momentum + crate.center_of_mass.cross(crate.momentum);
    for (Index i = 0; i < place.model->free_count; ++i) {
      sum += place.model->mass[i] * place.state.now.position[i].cross(place.state.now.velocity[i]);
    }
    return sum;
  };
  const Vec3 before = momentum();
  const Vec3 angular_before = angular_momentum();
  const Vec3 crate_before = place.state.now.rigid[0].momentum;
  std::vector<Real> pressure = random_numbers(place.count(), 3);
  for (Real& p : pressure) p *= 1e4;
  place.response->accelerate(pressure);
  place.response->add(1);
  place.response->kick(0.01);
  const Real exchanged = (place.state.now.rigid[0].momentum - crate_before).norm();
  EXPECT_GT(exchanged, 0.1);
  EXPECT_LT((momentum() - before).norm(), 1e-12 * exchanged);
  EXPECT_LT((angular_momentum() - angular_before).norm(), 1e-12 * exchanged);
}

}  // namespace
}  // namespace vat::test::pressure_response_test
