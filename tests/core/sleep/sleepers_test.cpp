#include "core/sleep/sleepers.h"

#include <gtest/gtest.h>

#include "core/laws/vat_motion.h"
#include "core/sleep/islands.h"
#include "core/sleep/resting_bodies.h"
#include "core/state/body_state.h"
#include "tests/core/support/resting_scenes.h"
#include "tests/support/force_probe.h"

// The columns of a subset of a model's bodies.

namespace vat::test::sleepers_test {
namespace {

BodyDescription make_cubes(const char* name, BodyKind kind, const char* material, Real x) {
  BodyDescription body = make_crate(name, x);
  body.kind = kind;
  body.material = material;
  return body;
}

/// Two bodies of each kind, in an order that differs from the order of the columns.
Scene make_all_kinds() {
  Scene scene = make_resting_scene();
  scene.pressure_solver = PressureSolver::incompressible;
  scene.materials.push_back(make_liquid("water", 1000, {100, 1, 0.2}));
  scene.materials[0].tearing_strain = 0.5;
  const std::vector<SpringDescription> spring = {{0, 1, {100, 1}, {}}, {3, 9, {50, 1}, {}}};
  for (const char* which : {"a", "b"}) {
    const Real x = which[0] == 'a' ? 0 : 5;
    const std::string name = which;
    scene.bodies.push_back(make_crate(name + " rigid", {x, 0, 2}));
    scene.bodies.push_back(make_cubes((name + " liquid").c_str(), BodyKind::liquid, "water", x));
    scene.bodies.push_back(
        make_cubes((name + " soft").c_str(), BodyKind::deformable, "wood", x + 1));
    scene.bodies.back().springs = spring;
  }
  return scene;
}

/// Returns a configuration whose values are all different.
Configuration number_all(const Model& model) {
  Configuration at = initial_state(model).now;
  Real n = 0;
  for (Vec3& p : at.position) p = Vec3(++n, n, n);
  for (Vec3& v : at.velocity) v = Vec3(++n, n, n);
  for (Real& p : at.pressure) p = ++n;
  for (SpringState& spring : at.springs) spring.rest_length = ++n;
  for (RigidState& rigid : at.rigid) rigid.momentum.x() = ++n;
  return at;
}

ContactImpulse make_contact(Index particle, std::uint64_t other, Real force) {
  ContactImpulse contact;
  contact.particle = particle;
  contact.other = other;
  contact.drift.x() = force;
  return contact;
}

TEST(RestingBodies, AreNearIfAParticleIsCloserThanTheDistance) {
  constexpr Real kDistance = 0.1;
  Scene scene = make_resting_scene();
  scene.bodies = {make_crate("crate", {0, 0, 1})};
  const auto model = compile_scene(scene);
  const std::vector<Vec3> positions = initial_state(*model).now.position;
  RestingBodies resting;
  resting.build(*model, positions, {0}, kDistance);
  Vec3 corner = positions.front();
  for (const Vec3& p : positions) corner = corner.cwiseMax(p);
  // The second point is in the enlarged box of the body.
  for (const auto& [offset, is_near] : {std::pair(0.05, true), std::pair(0.09, false)}) {
    const std::vector<Vec3> points = {corner + Vec3(offset, offset, 0)};
    std::vector<Index> candidates;
    resting.find_candidates(points, kDistance, candidates);
    ASSERT_EQ(candidates.size(), 1U) << offset;
    resting.keep_near(points, kDistance, candidates);
    EXPECT_EQ(candidates.size(), is_near ? 1U : 0U) << offset;
  }
}

TEST(Sleepers, PartAndRestMakeTheWhole) {
  const auto whole = compile_scene(make_all_kinds());
  Configuration all = number_all(*whole);
  const auto first_of = [&](std::size_t body) { return whole->bodies[body].particles.begin; };
  all.contacts = {make_contact(first_of(0), 4, 1), make_contact(first_of(0) + 3, 2, 2),
                  make_contact(first_of(3), 4, 3),
                  make_contact(first_of(3) + 1, kWallCount + std::uint64_t{first_of(3)}, 4)};
  const std::vector<Index> islands = {0, kAwake, 0, kAwake, 0, kAwake};
  const Sleepers sleepers(whole, all, islands);
  const auto awake = compile_awake(*whole, islands);
  ASSERT_EQ(awake->bodies.size(), 3U);
  const Configuration part = part_of(*whole, all, *awake);
  EXPECT_EQ(part.position.size(), awake->particle_count);
  EXPECT_EQ(part.contacts.size(), 2U);

  Configuration back = sleepers.configuration;
  EXPECT_EQ(back.contacts.size(), 2U);
  for (Index b = 1; b < 6; b += 2) {  // as if these bodies did not exist
    const IndexRange& range = whole->bodies[b].particles;
    for (Index i = range.begin; i < range.end; ++i) back.position[i].setZero();
    for (Index i = range.begin; i < range.end; ++i) back.velocity[i].setZero();
  }
  write_part(*awake, part, *whole, back);
  add_contacts_of_part(*awake, part, *whole, back);
  EXPECT_EQ(back.position, all.position);
  EXPECT_EQ(back.velocity, all.velocity);
  EXPECT_EQ(back.pressure, all.pressure);
  for (std::size_t n = 0; n < all.springs.size(); ++n) {
    EXPECT_EQ(back.springs[n].rest_length, all.springs[n].rest_length);
  }
  for (std::size_t n = 0; n < all.rigid.size(); ++n) {
    EXPECT_EQ(back.rigid[n].momentum, all.rigid[n].momentum);
  }
  ASSERT_EQ(back.contacts.size(), all.contacts.size());
  for (std::size_t n = 0; n < all.contacts.size(); ++n) {
    EXPECT_EQ(back.contacts[n].particle, all.contacts[n].particle);
    EXPECT_EQ(back.contacts[n].other, all.contacts[n].other);
    EXPECT_EQ(back.contacts[n].drift, all.contacts[n].drift);
  }
}

TEST(Islands, AreNearbyBodiesAndAnAwakeBodyKeepsThemAwake) {
  Scene scene = make_resting_scene();
  // Particles detect each other at 0.1 m. Islands are at least 0.25 m apart.
  scene.bodies = {make_crate("a", 0.0), make_crate("b", 0.2 + 0.249), make_crate("c", 5.0),
                  make_crate("d", 5.2 + 0.251), make_marble("e", {0, 9, 0.1})};
  const auto model = compile_scene(scene);
  Configuration at = initial_state(*model).now;
  EXPECT_EQ(find_resting_islands(*model, at, {1, 1, 1, 1, 1}), (std::vector<Index>{0, 0, 2, 3, 4}));
  EXPECT_EQ(find_resting_islands(*model, at, {0, 1, 1, 0, 1}),
            (std::vector<Index>{kAwake, kAwake, 2, kAwake, 4}));
  // In a step of 1/240 s it may approach by 0.3 m, and must stay 0.15 m away.
  at.rigid[3].momentum.x() = -36 * 2.7;
  EXPECT_EQ(find_resting_islands(*model, at, {0, 1, 1, 0, 1}),
            (std::vector<Index>{kAwake, kAwake, kAwake, kAwake, 4}));
}

TEST(Sleepers, KeepTheirForces) {
  const auto whole = compile_scene(make_all_kinds());
  const auto awake = compile_awake(*whole, {kAwake, 0, 0, 0, kAwake, kAwake});
  Forces forces = initial_state(*whole).forces;
  Real n = 0;
  for (Vec3& force : forces.particle) force.x() = ++n;
  for (Vec3& force : forces.rigid_force) force.x() = ++n;
  for (Vec3& torque : forces.rigid_torque) torque.x() = ++n;
  forces.transport.assign(whole->liquid_count, Vec3::Zero());
  for (Vec3& velocity : forces.transport) velocity.x() = ++n;
  const Forces part = forces_of_part(*whole, forces, *awake);
  const std::size_t same[] = {0, 4, 5};
  for (std::size_t b = 0; b < 3; ++b) {
    const ModelBody& here = awake->bodies[b];
    const ModelBody& there = whole->bodies[same[b]];
    for (Index i = 0; i < here.particles.size(); ++i) {
      EXPECT_EQ(part.particle[here.particles.begin + i],
                forces.particle[there.particles.begin + i]);
      if (here.kind != BodyKind::liquid) continue;
      EXPECT_EQ(part.transport[here.particles.begin + i],
                forces.transport[there.particles.begin + i]);
    }
  }
  EXPECT_EQ(part.rigid_force[0], forces.rigid_force[0]);
  EXPECT_EQ(part.rigid_torque[0], forces.rigid_torque[0]);
}

// The kernels of liquids are scaled to the lattice of the first liquid.
TEST(Sleepers, LiquidsKeepTheirConstants) {
  Scene scene = make_resting_scene();
  scene.materials.push_back(make_liquid("water", 1000, {100, 1, 0.2}));
  scene.materials.push_back(make_liquid("oil", 800, {100, 1, 0.2}));
  scene.pressure_solver = PressureSolver::tait;
  scene.bodies = {make_cubes("water", BodyKind::liquid, "water", 0),
                  make_cubes("oil", BodyKind::liquid, "oil", 5)};
  scene.bodies[1].shape = make_particles(make_lattice(3, 3, 3, 0.1), 0.4);
  const auto whole = compile_scene(scene);
  const auto awake = compile_awake(*whole, {0, kAwake});
  const auto alone = compile_scene([&] {
    Scene oil = scene;
    oil.bodies = {scene.bodies[1]};
    return oil;
  }());
  EXPECT_EQ(awake->liquids[2]->spacing, whole->liquids[2]->spacing);
  EXPECT_NE(alone->liquids[2]->spacing, whole->liquids[2]->spacing);
}

}  // namespace
}  // namespace vat::test::sleepers_test
