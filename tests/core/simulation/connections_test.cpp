// Springs and contacts as reported by connections().

#include <gtest/gtest.h>

#include "tests/support/shaken_vat.h"

namespace vat::test::connections_test {
namespace {

constexpr ConnectionQuery kAll{{}, 1'000'000};

BodyDescription particle(const char* name, BodyKind kind, const Vec3& position) {
  return make_body(name, kind, "stone", make_particles({position}, 1), 0.05);
}

Scene pair_scene(const InterfaceConstants& interface) {
  Scene scene = make_scene(IntegratorId::symplectic_euler, 1e-3, {make_material("stone")});
  scene.default_interface = interface;
  return scene;
}

TEST(Connections, HaveTheStrainOfEachSpringOnce) {
  Scene scene = pair_scene({1000, 1});
  BodyDescription rope = make_body("rope", BodyKind::deformable, "stone",
                                   make_particles({{0, 0, 0}, {1, 0, 0}, {1, 3, 0}}, 1), 0.05);
  rope.springs = {{0, 1, {10, 0}, 0.8}, {1, 2, {10, 0}, 4}};
  BodyDescription other = rope;
  other.name = "other";
  other.position = {0, 0, 5};
  scene.bodies = {rope, other};
  const Simulation simulation = make_simulation(scene);
  const BodyId first = simulation.bodies()[0].id;
  const BodyId second = simulation.bodies()[1].id;
  const Connections all = simulation.connections(kAll).value();
  EXPECT_EQ(all.springs.total, 4U);
  EXPECT_EQ(all.contacts.total, 0U);
  ASSERT_EQ(all.springs.sample.size(), 4U);
  const Connections of_second = simulation.connections({second, 100}).value();
  ASSERT_EQ(of_second.springs.sample.size(), 2U);
  for (const std::size_t b : {0U, 1U}) {
    const BodyId id = b == 0 ? first : second;
    const ConnectedPair& stretched = all.springs.sample[2 * b];
    EXPECT_EQ(stretched.a, (ConnectedParticle{id, 0}));
    EXPECT_EQ(stretched.b, (ConnectedParticle{id, 1}));
    EXPECT_NEAR(stretched.value, 1 / 0.8 - 1, 1e-15);
    EXPECT_NEAR(all.springs.sample[2 * b + 1].value, 3.0 / 4 - 1, 1e-15);
  }
  EXPECT_EQ(of_second.springs.sample[1].a, (ConnectedParticle{second, 1}));
}

TEST(Connections, LeaveOutTornSprings) {
  Scene scene = pair_scene({1000, 1});
  scene.materials[0].tearing_strain = 0.1;
  BodyDescription rope = make_body("rope", BodyKind::deformable, "stone",
                                   make_particles({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 1), 0.05);
  rope.springs = {{0, 1, {10, 0}, 0.5}, {1, 2, {10, 0}, 1.0}};
  scene.bodies = {rope};
  Simulation simulation = make_advanced(scene, 1);
  const ConnectionList springs = simulation.connections(kAll).value().springs;
  ASSERT_EQ(springs.total, 1U);
  EXPECT_EQ(springs.sample[0].b.particle, 2U);
}

// Spring and damping force of two balls that overlap by 0.02 m and approach at 3 m/s.
TEST(Connections, HaveTheForceOfEachContact) {
  Scene scene = pair_scene({1000, 2});
  scene.bodies = {particle("a", BodyKind::rigid, {0, 0, 0}),
                  particle("b", BodyKind::deformable, {0.08, 0, 0}),
                  particle("c", BodyKind::rigid, {0, 0.2, 0})};
  scene.bodies[0].velocity = {3, 1, 0};
  const Simulation simulation = make_simulation(scene);
  const ConnectionList contacts = simulation.connections(kAll).value().contacts;
  ASSERT_EQ(contacts.total, 1U);
  EXPECT_NEAR(contacts.sample[0].value, 1000 * 0.02 + 2 * 3, 1e-12);
  EXPECT_NE(contacts.sample[0].a.body, contacts.sample[0].b.body);
  EXPECT_EQ(simulation.connections({simulation.bodies()[1].id, 9}).value().contacts.total, 1U);
  EXPECT_EQ(simulation.connections({simulation.bodies()[2].id, 9}).value().contacts.total, 0U);
}

// A column of cubes at rest. Each contact carries the weight above it.
TEST(Connections, OfAStackCarryTheWeightAbove) {
  for (const InterfaceLaw law : {InterfaceLaw::penalty, InterfaceLaw::projection}) {
    SCOPED_TRACE(to_string(law));
    InterfaceConstants interface { 2e4, 50 };
    interface.law = law;
    if (law == InterfaceLaw::projection) interface.stiffness = interface.damping = 0;
    Scene scene = pair_scene(interface);
    scene.gravity = {0, 0, -9.81};
    scene.vat = Vat{{-1, -1, 0}, {1, 1, 2}, false, {}};
    for (int n = 0; n < 3; ++n) {
      BodyDescription cube = make_body("cube " + std::to_string(n), BodyKind::rigid, "stone",
                                       make_particles(make_lattice(2, 2, 2, 0.1), 0.5), 0.05);
      cube.position = {0, 0, 0.1 + 0.2 * n};
      scene.bodies.push_back(cube);
    }
    Simulation simulation = make_simulation(scene);
    // Penalty springs come to rest. Without friction, the column falls after one or two seconds.
    simulation.advance(law == InterfaceLaw::penalty ? 1000 : 200);
    const std::uint64_t hash = simulation.state_hash();
    Real lower = 0;
    Real upper = 0;
    const Connections all = simulation.connections(kAll).value();
    for (const ConnectedPair& contact : all.contacts.sample) {
      const bool has_top = contact.a.body == simulation.bodies()[2].id ||
                           contact.b.body == simulation.bodies()[2].id;
      (has_top ? upper : lower) += contact.value;
    }
    EXPECT_NEAR(upper, 4 * 9.81, 0.01 * 4 * 9.81);
    EXPECT_NEAR(lower, 8 * 9.81, 0.01 * 8 * 9.81);
    EXPECT_EQ(simulation.state_hash(), hash) << "queries do not change the state";
  }
}

TEST(Connections, AreThinnedToSoManyAtMost) {
  Simulation simulation = make_advanced(make_shaken_vat(IntegratorId::velocity_verlet), 200);
  const Connections all = simulation.connections(kAll).value();
  ASSERT_GT(all.springs.total, 50U);
  ASSERT_GT(all.contacts.total, 5U);
  EXPECT_EQ(all.springs.total, simulation.spring_count());
  for (const std::size_t most : {1UL, 7UL, all.springs.total - 1, all.springs.total}) {
    const Connections some = simulation.connections({{}, most}).value();
    for (const auto& [whole, part] :
         {std::pair(&all.springs, &some.springs), std::pair(&all.contacts, &some.contacts)}) {
      EXPECT_EQ(part->total, whole->total);
      EXPECT_LE(part->sample.size(), most);
      EXPECT_EQ(part->sample.size(), (whole->total + part->every - 1) / part->every);
      for (std::size_t i = 0; i < part->sample.size(); ++i) {
        EXPECT_EQ(part->sample[i].a, whole->sample[i * part->every].a);
        EXPECT_EQ(part->sample[i].value, whole->sample[i * part->every].value);
      }
    }
  }
  const Connections none = simulation.connections({{}, 0}).value();
  EXPECT_EQ(none.springs.total, all.springs.total);
  EXPECT_TRUE(none.springs.sample.empty());
  EXPECT_EQ(simulation.connections({BodyId{77}, 1}).errors()[0].code, "no_such_body");
}

}  // namespace
}  // namespace vat::test::connections_test
