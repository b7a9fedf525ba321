// Commands that move bodies and change materials of a running simulation.

#include <gtest/gtest.h>

#include <cmath>

#include "core/limits.h"
#include "tests/support/edited_scene.h"
#include "tests/support/errors.h"
#include "tests/support/saved_bits.h"

namespace vat::test::edit_commands_test {
namespace {

Vec3 center_of(const Simulation& simulation, std::size_t body) {
  return simulation.diagnostics().bodies[body].center_of_mass;
}

class MoveBody : public testing::Test {
 protected:
  BodyId id(std::size_t body) const { return simulation.bodies()[body].id; }
  Simulation simulation = make_simulation(sampled_scene());
};

TEST_F(MoveBody, ShiftsLiquidAndDeformableBodiesAsTheyAre) {
  simulation.advance(100);
  for (const std::size_t body : {0U, 1U}) {
    const auto places = copy_of(simulation.bodies()[body].positions);
    const auto velocities = copy_of(simulation.bodies()[body].velocities);
    const auto others = copy_of(simulation.bodies()[2].positions);
    const Vec3 shift(0.05, -0.03, 0.2);
    const Vec3 target = center_of(simulation, body) + shift;
    ASSERT_TRUE(simulation.move_body(id(body), {target, {}, {}}).ok());
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_LT((position_of(simulation, body, i) - places[i] - shift).norm(), 1e-14);
    }
    EXPECT_EQ(copy_of(simulation.bodies()[body].velocities), velocities);
    EXPECT_EQ(copy_of(simulation.bodies()[2].positions), others);
    ASSERT_TRUE(simulation.move_body(id(body), {target, {}, Vec3(1, 2, 3)}).ok());
    const BodyView moved = simulation.bodies()[body];
    for (const Vec3& v : moved.velocities) EXPECT_EQ(v, Vec3(1, 2, 3));
    expect_goes_on(simulation, 10);
  }
}

TEST_F(MoveBody, TurnsRigidBodiesAndKeepsTheirAngularVelocity) {
  simulation.advance(50);
  const RigidPose before = *simulation.bodies()[2].pose;
  const Quat turned(Eigen::AngleAxis<Real>(1, Vec3::UnitX()));
  ASSERT_TRUE(simulation.move_body(id(2), {{0.4, 0.4, 0.7}, turned, {}}).ok());
  const BodyView body = simulation.bodies()[2];
  EXPECT_EQ(body.pose->center_of_mass, Vec3(0.4, 0.4, 0.7));
  EXPECT_LT(body.pose->orientation.angularDistance(turned), 1e-7);
  EXPECT_LT((body.pose->velocity - before.velocity).norm(), 1e-15);
  EXPECT_LT((body.pose->angular_velocity - before.angular_velocity).norm(), 1e-13);
  for (std::size_t i = 0; i < body.positions.size(); ++i) {
    const Vec3 place = Vec3(0.4, 0.4, 0.7) + turned * body.local_positions[i];
    EXPECT_LT((body.positions[i] - place).norm(), 1e-14);
  }
  ASSERT_TRUE(simulation.move_body(id(2), {{0.4, 0.4, 0.7}, {}, Vec3(1, 0, 0)}).ok());
  EXPECT_LT((simulation.bodies()[2].pose->velocity - Vec3(1, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(simulation.bodies()[2].pose->angular_velocity, Vec3::Zero());
  EXPECT_LT(simulation.bodies()[2].pose->orientation.angularDistance(turned), 1e-7);
  expect_goes_on(simulation, 10);
}

// The corners of the shape, displaced by the origin, enclose the particles.
TEST_F(MoveBody, TheShapeOfARigidBodyIsAroundItsParticles) {
  simulation.advance(50);
  const auto check = [&] {
    const BodyView body = simulation.bodies()[2];
    const BoxShape box = std::get<BoxShape>(simulation.scene().bodies[2].shape);
    Vec3 low = Vec3::Constant(1);
    Vec3 high = Vec3::Constant(-1);
    for (const Vec3& local : body.local_positions) {
      low = low.cwiseMin(local);
      high = high.cwiseMax(local);
    }
    const Vec3 half = Vec3::Constant(0.025);  // half the spacing
    EXPECT_LT((low - half - (body.shape_origin + box.center - box.size / 2)).norm(), 1e-14);
    EXPECT_LT((high + half - (body.shape_origin + box.center + box.size / 2)).norm(), 1e-14);
  };
  check();
  const Quat turned(Eigen::AngleAxis<Real>(1, Vec3::UnitX()));
  ASSERT_TRUE(simulation.move_body(id(2), {{0.4, 0.4, 0.7}, turned, {}}).ok());
  check();
}

// Moving a body at the start is equivalent to describing it there.
TEST_F(MoveBody, MovesTheOriginOfItsDescription) {
  const Quat turned(Eigen::AngleAxis<Real>(-0.5, Vec3::UnitZ()));
  ASSERT_TRUE(simulation.move_body(id(2), {{0.31, 0.35, 0.8}, turned, {}}).ok());
  ASSERT_TRUE(
      simulation.move_body(id(0), {center_of(simulation, 0) + Vec3(0.01, 0, 0.05), {}, {}}).ok());
  ASSERT_TRUE(
      simulation.move_body(id(1), {center_of(simulation, 1) + Vec3(0, -0.1, 0.3), {}, {}}).ok());
  const Simulation fresh = make_simulation(simulation.scene());
  for (std::size_t b = 0; b < 3; ++b) {
    const BodyView moved = simulation.bodies()[b];
    const BodyView described = fresh.bodies()[b];
    ASSERT_EQ(moved.positions.size(), described.positions.size());
    for (std::size_t i = 0; i < moved.positions.size(); ++i) {
      EXPECT_LT((moved.positions[i] - described.positions[i]).norm(), 1e-14) << b;
      EXPECT_LT((moved.velocities[i] - described.velocities[i]).norm(), 1e-13) << b;
    }
  }
}

TEST_F(MoveBody, KeepsHeldParticles) {
  ASSERT_TRUE(simulation.grab_start(3, id(1), 0, {0.5, 0.5, 0.5}).ok());
  ASSERT_TRUE(simulation.move_body(id(1), {{0.6, 0.6, 0.6}, {}, {}}).ok());
  EXPECT_TRUE(simulation.grab_move(3, {0.4, 0.5, 0.5}).ok());
}

TEST_F(MoveBody, RefusesImpossibleMotionsAndChangesNothing) {
  const std::uint64_t hash = simulation.state_hash();
  const auto error = [&](BodyId body, const BodyPlacement& place) {
    return errors_of(simulation.move_body(body, place));
  };
  EXPECT_EQ(error(99, {}), "no_such_body /body");
  EXPECT_EQ(error(id(2), {{0.5, 0.5, 0.05}, {}, {}}), "outside_vat /position");
  EXPECT_EQ(error(id(0), {{2, 0.5, 0.5}, {}, {}}), "outside_vat /position");
  EXPECT_EQ(error(id(0), {{0.5, 0.5, std::nan("")}, {}, {}}), "out_of_range /position");
  EXPECT_EQ(error(id(0), {{0.5, 0.5, 0.5}, Quat::Identity(), {}}), "not_allowed /orientation");
  EXPECT_EQ(error(id(2), {{0.5, 0.5, 0.5}, Quat(0, 0, 0, 0), {}}), "out_of_range /orientation");
  EXPECT_EQ(error(id(2), {{0.5, 0.5, 0.5}, {}, Vec3(2 * kMaxSpeed, 0, 0)}),
            "out_of_range /velocity");
  EXPECT_EQ(simulation.state_hash(), hash);
}

TEST(MoveBodyInThePlane, StaysInIt) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.dimensions = 2;
  scene.materials = {make_material("wood")};
  scene.bodies = {make_body("plate", BodyKind::rigid, "wood",
                            make_particles({{0, 0, 0}, {0.1, 0, 0}, {0, 0, 0.1}}, 1), 0.05)};
  Simulation simulation = make_simulation(scene);
  const BodyId id = simulation.bodies()[0].id;
  const Quat about_y(Eigen::AngleAxis<Real>(1, Vec3::UnitY()));
  EXPECT_TRUE(simulation.move_body(id, {{1, 0, 2}, about_y, Vec3(1, 0, 0)}).ok());
  const Quat about_x(Eigen::AngleAxis<Real>(1, Vec3::UnitX()));
  EXPECT_EQ(simulation.move_body(id, {{1, 0, 2}, about_x, {}}).errors()[0].path, "/orientation");
  EXPECT_EQ(simulation.move_body(id, {{1, 1, 2}, {}, {}}).errors()[0].path, "/position");
  EXPECT_EQ(simulation.move_body(id, {{1, 0, 2}, {}, Vec3(0, 1, 0)}).errors()[0].path, "/velocity");
}

class SetMaterial : public testing::Test {
 protected:
  Material material(const char* name) const {
    for (const Material& one : simulation.scene().materials) {
      if (one.name == name) return one;
    }
    throw std::runtime_error("no such material");
  }
  std::string error(const Material& changed) { return errors_of(simulation.set_material(changed)); }

  Simulation simulation = make_simulation(sampled_scene());
};

TEST_F(SetMaterial, ADensityChangesMassesAndNotVelocities) {
  simulation.advance(50);
  const Diagnostics before = simulation.diagnostics();
  const auto places = copy_of(simulation.bodies()[0].positions);
  const RigidPose pose = *simulation.bodies()[2].pose;
  for (const char* name : {"water", "jelly", "wood"}) {
    Material changed = material(name);
    changed.density *= 3;
    ASSERT_TRUE(simulation.set_material(changed).ok());
  }
  const Diagnostics after = simulation.diagnostics();
  EXPECT_EQ(copy_of(simulation.bodies()[0].positions), places);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_NEAR(after.bodies[b].mass, 3 * before.bodies[b].mass, 1e-12 * before.bodies[b].mass);
    EXPECT_LT((after.bodies[b].linear_momentum - 3 * before.bodies[b].linear_momentum).norm(),
              1e-12 * (1 + before.bodies[b].linear_momentum.norm()));
  }
  const RigidPose now = *simulation.bodies()[2].pose;
  EXPECT_LT((now.velocity - pose.velocity).norm(), 1e-14);
  EXPECT_LT((now.angular_velocity - pose.angular_velocity).norm(), 1e-12);
  EXPECT_NEAR(after.mean_density_error, before.mean_density_error, 1e-12)
      << "the rest density changes too";
  expect_goes_on(simulation, 20);
}

TEST_F(SetMaterial, SpringsGetTheirConstants) {
  simulation.advance(100);
  const Real energy = simulation.diagnostics().elastic_energy;
  ASSERT_GT(energy, 0);
  Material changed = material("jelly");
  changed.springs->structural->stiffness *= 2;
  changed.springs->shear->stiffness *= 2;
  changed.tearing_strain = 0.5;
  ASSERT_TRUE(simulation.set_material(changed).ok());
  EXPECT_NEAR(simulation.diagnostics().elastic_energy, 2 * energy, 1e-12 * energy);
  EXPECT_EQ(simulation.scene().materials[1].springs->shear->stiffness, 600);
  expect_goes_on(simulation, 20);
}

TEST_F(SetMaterial, PlasticStrainIsKept) {
  Material plastic = material("jelly");
  plastic.plasticity = Plasticity{1e-4, 0.1, 0, 0.5};
  ASSERT_TRUE(simulation.set_material(plastic).ok());
  simulation.advance(300);
  const ConnectionList before = simulation.connections({{}, 100000}).value().springs;
  plastic.springs->structural->stiffness *= 2;
  ASSERT_TRUE(simulation.set_material(plastic).ok());
  const ConnectionList after = simulation.connections({{}, 100000}).value().springs;
  ASSERT_EQ(after.sample.size(), before.sample.size());
  for (std::size_t i = 0; i < after.sample.size(); ++i) {
    EXPECT_EQ(after.sample[i].value, before.sample[i].value);
  }
  plastic.springs->structural.reset();  // other springs: existing springs restart
  ASSERT_TRUE(simulation.set_material(plastic).ok());
  EXPECT_LT(simulation.spring_count(), before.total);
  simulation.advance(10);
}

TEST_F(SetMaterial, ANewOneIsThereForBodies) {
  const Material steel = make_material("steel", 7800);
  ASSERT_TRUE(simulation.set_material(steel).ok());
  BodyDescription ball =
      make_body("ball", BodyKind::rigid, "steel", make_particles({{0, 0, 0}}, 0.1), 0.02);
  ball.position = {0.8, 0.2, 0.8};
  EXPECT_TRUE(simulation.add_body(ball).ok());
  simulation.advance(10);
}

TEST_F(SetMaterial, AnAppearanceLeavesTheStateUnchanged) {
  simulation.advance(50);
  const std::uint64_t before = simulation.state_hash();
  Simulation other = Simulation::from(simulation.snapshot());
  Material painted = material("jelly");
  painted.appearance.colour = Colour{1, 2, 3};
  painted.appearance.roughness = 0.25;
  ASSERT_TRUE(simulation.set_material(painted).ok());
  EXPECT_EQ(simulation.scene().materials[1], painted);
  EXPECT_EQ(simulation.state_hash(), before);
  simulation.advance(20);
  other.advance(20);
  EXPECT_EQ(simulation.state_hash(), other.state_hash());
  expect_goes_on(simulation, 2);
  const auto loaded = Simulation::load(simulation.snapshot().to_bytes());
  EXPECT_EQ(loaded.value().scene().materials[1], painted);
  painted.appearance.opacity = 1.5;
  EXPECT_EQ(error(painted), "out_of_range /material/appearance/opacity");
}

TEST_F(SetMaterial, MassesThatWereGivenStay) {
  ASSERT_TRUE(simulation.melt_body(simulation.bodies()[1].id, "water").ok());
  const Real melted = simulation.diagnostics().bodies[1].mass;
  const Real poured = simulation.diagnostics().bodies[0].mass;
  Material water = material("water");
  water.density = 500;
  ASSERT_TRUE(simulation.set_material(water).ok());
  EXPECT_EQ(simulation.diagnostics().bodies[1].mass, melted);
  EXPECT_NEAR(simulation.diagnostics().bodies[0].mass, poured / 2, 1e-12 * poured);
  expect_goes_on(simulation, 20);
}

TEST_F(SetMaterial, RefusalsNameThePath) {
  const std::uint64_t hash = simulation.state_hash();
  Material changed = material("water");
  changed.density = -1;
  EXPECT_EQ(error(changed), "out_of_range /material/density");
  changed = material("water");
  changed.liquid.reset();
  EXPECT_EQ(error(changed), "not_liquid /material");
  changed = material("water");
  changed.liquid->support_radius = 1;
  EXPECT_EQ(error(changed), "out_of_range /material") << "limited by the spacing of its bodies";
  changed = material("jelly");
  changed.springs->shear->stiffness = std::nan("");
  EXPECT_EQ(error(changed), "out_of_range /material/springs/shear/stiffness");
  EXPECT_EQ(error(make_material("vat")), "reserved_name /material/name");
  EXPECT_EQ(simulation.state_hash(), hash);
}

TEST(SetMaterialOfAnEmitter, KeepsItsSupportRadius) {
  const Scene scene = scene_with_tap();
  Simulation simulation = make_advanced(scene, 300);
  const Real before = simulation.diagnostics().bodies[0].mass;
  Material water = scene.materials[0];
  water.density = 2000;
  ASSERT_TRUE(simulation.set_material(water).ok());
  EXPECT_NEAR(simulation.diagnostics().bodies[0].mass, 2 * before, 1e-12 * before);
  expect_goes_on(simulation, 20);
  water.liquid->support_radius = 0.13;
  EXPECT_EQ(simulation.set_material(water).errors()[0].path, "/material/liquid/support_radius");
  EXPECT_EQ(
      simulation.move_body(simulation.bodies()[0].id, {{0.5, 0.5, 0.5}, {}, {}}).errors()[0].path,
      "/body")
      << "some particles are in the nozzle";
}

}  // namespace
}  // namespace vat::test::edit_commands_test
