#include <gtest/gtest.h>

#include <random>

#include "core/neighbours/periodic_box.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::periodic_test {
namespace {

std::vector<Vec3> make_random_points(std::size_t count, const Vec3& min, const Vec3& max,
                                     unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<Real> unit(0, 1);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = min[axis] + unit(random) * (max - min)[axis];
  }
  return points;
}

TEST(PeriodicBox, WrapsIntoTheBoxAndLeavesOtherAxesAlone) {
  const PeriodicBox box(Periodicity{{-1, 0, 2}, {2, 1, 4}, {true, false, true}});
  EXPECT_LT((box.wrap({2.5, 7, 1.75}) - Vec3(-0.5, 7, 3.75)).norm(), 1e-14);
  EXPECT_LT((box.wrap({-31.5, -7, 400.5}) - Vec3(1.5, -7, 2.5)).norm(), 1e-12);
  EXPECT_EQ(box.wrap({2, 0, 4}), Vec3(-1, 0, 2));
  for (const Vec3& p : make_random_points(1000, {-1, -5, 2}, {2, 5, 4}, 1)) {
    EXPECT_EQ(box.wrap(p), p);
  }
  for (const Vec3& p : make_random_points(1000, {-90, -90, -90}, {90, 90, 90}, 2)) {
    const Vec3 inside = box.wrap(p);
    EXPECT_TRUE(inside.x() >= -1 && inside.x() < 2 && inside.z() >= 2 && inside.z() < 4);
    EXPECT_EQ(inside.y(), p.y());
  }
}

TEST(PeriodicBox, WrapsPositionsRoundedToTheFarSide) {
  const PeriodicBox box(Periodicity{Vec3::Zero(), Vec3::Ones(), {true, true, true}});
  EXPECT_EQ(box.wrap({-1e-20, -1e-300, 1}), Vec3(0, 0, 0));
}

TEST(PeriodicBox, FindsTheNearestImageAndItsOppositeToTheBit) {
  const PeriodicBox box(Periodicity{Vec3::Zero(), {1, 2, 3}, {true, true, false}});
  EXPECT_LT((box.nearest({0.9, -1.5, 2.9}) - Vec3(-0.1, 0.5, 2.9)).norm(), 1e-15);
  for (const Vec3& x : make_random_points(1000, {-1, -2, -9}, {1, 2, 9}, 3)) {
    EXPECT_EQ(box.nearest(x), Vec3(-box.nearest(-x)));
    EXPECT_LE(std::abs(box.nearest(x).x()), 0.5);
    EXPECT_LE(std::abs(box.nearest(x).y()), 1);
    EXPECT_EQ(box.nearest(x).z(), x.z());
  }
}

TEST(PeriodicBox, OfNothingDoesNothing) {
  const PeriodicBox box;
  EXPECT_FALSE(box.any());
  EXPECT_EQ(box.wrap({1e9, -1e9, 3}), Vec3(1e9, -1e9, 3));
  EXPECT_EQ(box.nearest({1e9, -1e9, 3}), Vec3(1e9, -1e9, 3));
  int images = 0;
  box.for_each_image({1, 2, 3}, 100, [&](const Vec3& shift) {
    EXPECT_EQ(shift, Vec3::Zero());
    ++images;
  });
  EXPECT_EQ(images, 1);
}

/// Random liquid and solids that touch one another and themselves, in a box that is periodic along
/// `axes`. All positions are in [0, 1]^3, moved by `shift`.
Scene make_random_scene(std::array<bool, 3> axes, const Vec3& shift) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-4,
                           {make_liquid("water", 1000, {10, 5, 0.2}), make_material("solid")});
  scene.materials[1].self_contact = SpringConstants{300, 1};
  scene.default_interface = {500, 2};
  const auto add = [&](const char* name, BodyKind kind, const char* material, std::size_t count,
                       unsigned seed) {
    ParticleShape shape =
        make_particles(make_random_points(count, Vec3::Zero(), Vec3::Ones(), seed), 2);
    if (kind != BodyKind::rigid) {
      shape.velocities = make_random_points(count, Vec3::Constant(-1), Vec3::Ones(), seed + 1000);
    }
    scene.bodies.push_back(make_body(name, kind, material, std::move(shape), 0.06));
    scene.bodies.back().position = shift;
  };
  add("water", BodyKind::liquid, "water", 300, 4);
  add("dust", BodyKind::deformable, "solid", 150, 5);
  add("grit", BodyKind::deformable, "solid", 150, 6);
  add("rock", BodyKind::rigid, "solid", 60, 7);
  scene.periodic = Periodicity{Vec3::Zero(), Vec3::Ones(), axes};
  return scene;
}

constexpr std::array<std::array<bool, 3>, 5> kAxes = {{{true, false, false},
                                                       {false, true, false},
                                                       {false, false, true},
                                                       {true, false, true},
                                                       {true, true, true}}};

/// Calls f(x_i - x_j) for all images of j within `reach` of i, by brute force.
template <class F>
void for_each_near_image(const Periodicity& periodic, const Vec3& x_ij, Real reach, F&& f) {
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if ((x && !periodic.axes[0]) || (y && !periodic.axes[1]) || (z && !periodic.axes[2])) {
          continue;
        }
        const Vec3 image = x_ij + Vec3(x, y, z);
        if (image.norm() < reach) f(image);
      }
    }
  }
}

TEST(Periodic, DensitiesEqualBruteForceOverImages) {
  for (const std::array<bool, 3>& axes : kAxes) {
    const Scene scene = make_random_scene(axes, Vec3::Zero());
    const ForceProbe probe(scene);
    const auto& points = std::get<ParticleShape>(scene.bodies[0].shape).positions;
    const Poly6 kernel(0.2);
    for (Index i = 0; i < points.size(); ++i) {
      Real expected = 0;
      for (const Vec3& other : points) {
        for_each_near_image(*scene.periodic, points[i] - other, 0.2,
                            [&](const Vec3& x) { expected += 2 * kernel.value(x.squaredNorm()); });
      }
      ASSERT_NEAR(probe.work().of<LiquidScratch>().density[i], expected, 1e-12 * expected);
    }
  }
}

TEST(Periodic, ContactsEqualBruteForceOverImages) {
  for (const std::array<bool, 3>& axes : kAxes) {
    Scene scene = make_random_scene(axes, Vec3::Zero());
    scene.bodies.erase(scene.bodies.begin());  // only contacts act on the remaining bodies
    scene.default_interface.damping = 0;
    scene.materials[1].self_contact.reset();
    std::mt19937_64 random(8);
    std::uniform_real_distribution<Real> radius(0.02, 0.1);
    for (BodyDescription& body : scene.bodies) {
      auto& shape = std::get<ParticleShape>(body.shape);
      for (std::size_t i = 0; i < shape.positions.size(); ++i) {
        shape.radii.push_back(radius(random));
      }
      body.radius.reset();
    }
    const ForceProbe probe(scene);
    const auto shape_of = [&](std::size_t b) -> const ParticleShape& {
      return std::get<ParticleShape>(scene.bodies[b].shape);
    };
    int across = 0;
    for (std::size_t a = 0; a < scene.bodies.size(); ++a) {
      for (Index i = 0; i < shape_of(a).positions.size(); ++i) {
        Vec3 expected = Vec3::Zero();
        for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
          if (a == b) continue;
          for (Index j = 0; j < shape_of(b).positions.size(); ++j) {
            const Vec3 x_ij = shape_of(a).positions[i] - shape_of(b).positions[j];
            const Real threshold = shape_of(a).radii[i] + shape_of(b).radii[j];
            for_each_near_image(*scene.periodic, x_ij, threshold, [&](const Vec3& x) {
              expected += 500 * (threshold - x.norm()) * x.normalized();
              across += x_ij.norm() > 0.5;
            });
          }
        }
        ASSERT_LT((probe.force(a, i) - expected).norm(), 1e-10);
      }
    }
    EXPECT_GT(across, 10);
  }
}

TEST(Periodic, SelfContactReachesAcrossTheSeam) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3, {make_material("solid")});
  scene.materials[0].self_contact = SpringConstants{300, 0};
  scene.bodies = {make_body("pair", BodyKind::deformable, "solid",
                            make_particles({{0.05, 0.5, 0.5}, {0.95, 0.5, 0.5}}, 1), 0.1)};
  scene.periodic = Periodicity{Vec3::Zero(), Vec3::Ones(), {true, false, false}};
  const ForceProbe probe(scene);
  EXPECT_NEAR(probe.force(0, 0).x(), 300 * 0.1, 1e-11);
  EXPECT_EQ(probe.force(0, 0), Vec3(-probe.force(0, 1)));
}

TEST(Periodic, ForcesDoNotChangeUnderTranslation) {
  constexpr std::array<bool, 3> kAll = {true, true, true};
  ForceProbe here(make_random_scene(kAll, Vec3::Zero()));
  Real greatest = 0;
  for (const Vec3& force : here.state().forces.particle) {
    greatest = std::max(greatest, force.norm());
  }
  for (const Vec3& shift : {Vec3(0.37, -0.61, 0.99), Vec3(1, 0, -1), Vec3(5.2, 3.3, -8.1)}) {
    const ForceProbe there(make_random_scene(kAll, shift));
    for (std::size_t b = 0; b < 4; ++b) {
      for (Index i = 0; i < here.model().bodies[b].particles.size(); ++i) {
        ASSERT_LT((there.force(b, i) - here.force(b, i)).norm(), 1e-12 * greatest);
      }
    }
  }
}

/// Two bodies that collide along x.
Scene make_collision(BodyKind kind, bool periodic) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3, {make_material("solid")});
  scene.default_interface = {2000, 1};
  const std::vector<Vec3> points = make_lattice(3, 3, 3, 0.1);
  for (int b = 0; b < 2; ++b) {
    scene.bodies.push_back(
        make_body(b == 0 ? "left" : "right", kind, "solid", make_particles(points, 0.1), 0.05));
    scene.bodies.back().position = {1.8 + 0.5 * b, 0.5 + 0.03 * b, 0.52};
    scene.bodies.back().velocity = {b == 0 ? 1.0 : -0.5, 0, 0};
    if (kind == BodyKind::deformable) {
      scene.bodies.back().springs = join_near(points, 0.15, {500, 0.5});
    }
  }
  if (periodic) {
    scene.periodic = Periodicity{Vec3::Zero(), Vec3::Constant(2), {true, false, false}};
  }
  return scene;
}

// Moves the second body by one more box length. The bodies then meet through an image.
TEST(Periodic, SolidsThatCrossTheSeamCollideAsInTheOpen) {
  for (const BodyKind kind : {BodyKind::rigid, BodyKind::deformable}) {
    for (const Real further : {0, 6}) {
      Scene scene = make_collision(kind, true);
      scene.bodies[1].position.x() += further;
      Simulation open = make_simulation(make_collision(kind, false));
      Simulation closed = make_simulation(scene);
      advance_to(open, 1);
      advance_to(closed, 1);
      EXPECT_LT(velocity_of(open, 0).x(), 0.5) << "no collision";
      for (std::size_t i = 0; i < 27; ++i) {
        EXPECT_LT((position_of(open, 0, i) - position_of(closed, 0, i)).norm(), 1e-9);
        const Vec3 moved = position_of(closed, 1, i) - Vec3(further, 0, 0);
        EXPECT_LT((position_of(open, 1, i) - moved).norm(), 1e-9);
      }
    }
  }
}

TEST(Periodic, LiquidEntersThroughTheOtherSide) {
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, 1e-3, {make_liquid("water", 500, {10, 1, 2})});
  const std::vector<Vec3> lattice = make_lattice(4, 4, 4, 1);
  scene.bodies = {
      make_body("water", BodyKind::liquid, "water", make_particles(lattice, 1000), 0.5)};
  scene.bodies[0].velocity = {30, 0, -7};
  scene.periodic = Periodicity{Vec3::Constant(-2), Vec3::Constant(2), {true, true, true}};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 1);
  for (std::size_t i = 0; i < 64; ++i) {
    const Vec3 p = position_of(simulation, 0, i);
    EXPECT_TRUE((p.array() >= -2).all() && (p.array() < 2).all());
    // In a box of four sites, 30 m is two sites, and -7 m is one site further.
    const PeriodicBox box(*scene.periodic);
    EXPECT_LT(box.nearest(box.wrap(p) - box.wrap(lattice[i] + Vec3(2, 0, 1))).norm(), 1e-9);
  }
}

TEST(Periodic, AxesHaveNoWalls) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-2, {make_material("solid")});
  scene.bodies = {
      make_body("ball", BodyKind::rigid, "solid", make_particles({{0.99, 0.5, 0.5}}, 1), 0.1)};
  scene.bodies[0].velocity = {5, 0, 0};
  scene.vat = Vat{Vec3::Zero(), Vec3::Ones(), true, {}, {}};
  scene.periodic = Periodicity{Vec3::Zero(), Vec3::Ones(), {true, false, false}};
  Simulation simulation = make_simulation(scene);
  advance_to(simulation, 20);
  EXPECT_NEAR(position_of(simulation, 0).x(), 100.99, 1e-9);
  EXPECT_EQ(simulation.diagnostics().particles_outside, 0U);
  EXPECT_EQ(simulation.diagnostics().contact_energy, 0);
}

}  // namespace
}  // namespace vat::test::periodic_test
