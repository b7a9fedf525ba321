#include "core/coupling/coupled_simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "tests/support/errors.h"
#include "tests/support/external_bodies.h"
#include "tests/support/scenes.h"
#include "tests/support/thread_runner.h"

namespace vat::test::coupled_simulation_test {
namespace {

using testing::StartsWith;

/// A bob on the left of its pivot, and deformable cubes in its way.
Scene bob_and_cubes() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_material("oak", 700), make_material("rubber")};
  scene.default_interface = {.stiffness = 2000, .damping = 2};
  BodyDescription bob;
  bob.name = "bob";
  bob.kind = BodyKind::rigid;
  bob.material = "oak";
  bob.shape = SphereShape{Vec3::Zero(), 0.1};
  bob.spacing = 0.05;
  scene.bodies = {bob};
  for (const Real x : {0.0, 0.4}) {
    const std::vector<Vec3> points = make_lattice(3, 3, 3, 0.05);
    BodyDescription cube =
        make_body("cube " + std::to_string(scene.bodies.size()), BodyKind::deformable, "rubber",
                  make_particles(points, 0.01), 0.03);
    cube.springs = join_near(points, 0.08, {500, 1});
    cube.position = {x, 0, -0.7};
    scene.bodies.push_back(cube);
  }
  scene.bodies.push_back(make_body("beads", BodyKind::deformable, "rubber",
                                   make_particles({{0, 2, 0}, {0.5, 2, 0}}, 0.1), 0.03));
  return scene;
}

std::unique_ptr<PendulumBody> make_pendulum() {
  return std::make_unique<PendulumBody>(PendulumBody::Settings{.length = 0.9, .angle = -0.7});
}

CoupledSimulation coupled_with_pendulum(TaskRunner* runner = nullptr) {
  CoupledSimulation coupled(Simulation::create(bob_and_cubes(), runner).value());
  EXPECT_TRUE(coupled.attach(1, make_pendulum()));
  return coupled;
}

TEST(CoupledSimulation, HasTheSameBitsForAnyNumberOfThreads) {
  CoupledSimulation serial = coupled_with_pendulum();
  ThreadRunner runner(3);
  CoupledSimulation parallel = coupled_with_pendulum(&runner);
  ASSERT_TRUE(serial.advance(400));
  ASSERT_TRUE(parallel.advance(150));
  ASSERT_TRUE(parallel.advance(250));
  EXPECT_EQ(serial.simulation().state_hash(), parallel.simulation().state_hash());
  CoupledSimulation alone = coupled_with_pendulum();
  ASSERT_TRUE(alone.detach(1));
  ASSERT_TRUE(alone.advance(400));
  EXPECT_NE(serial.simulation().state_hash(), alone.simulation().state_hash());
}

TEST(CoupledSimulation, ReportsAllSteps) {
  CoupledSimulation coupled = coupled_with_pendulum();
  const AdvanceReport report = coupled.advance(7).value();
  EXPECT_EQ(report.steps, 7u);
  EXPECT_GE(report.force_evaluations, 7u);
  EXPECT_EQ(report.least_step, 1e-3);
  EXPECT_EQ(coupled.simulation().time(), 7e-3);
}

TEST(CoupledSimulation, SavedBytesContinueWithTheSameBits) {
  CoupledSimulation coupled = coupled_with_pendulum();
  ASSERT_TRUE(coupled.advance(250));
  const std::vector<std::uint8_t> bytes = coupled.save().value();
  ASSERT_TRUE(coupled.advance(250));
  std::vector<std::string> names;
  auto loaded = CoupledSimulation::load(bytes, [&](std::string_view name) {
    names.emplace_back(name);
    return make_pendulum();
  });
  ASSERT_TRUE(loaded);
  EXPECT_EQ(names, std::vector<std::string>{"bob"});
  ASSERT_TRUE(loaded.value().advance(250));
  EXPECT_EQ(loaded.value().simulation().state_hash(), coupled.simulation().state_hash());
  EXPECT_EQ(loaded.value().save().value(), coupled.save().value());
}

TEST(CoupledSimulation, InvalidBytesAreRejected) {
  CoupledSimulation coupled = coupled_with_pendulum();
  std::vector<std::uint8_t> bytes = coupled.save().value();
  const auto make = [](std::string_view) { return make_pendulum(); };
  const auto make_none = [](std::string_view) { return nullptr; };
  const auto make_other = [](std::string_view) { return std::make_unique<ChainBody>(1); };
  EXPECT_EQ(errors_of(CoupledSimulation::load(bytes, make_none)), "not_restored /bodies/bob");
  EXPECT_EQ(errors_of(CoupledSimulation::load(bytes, make_other)), "not_restored /bodies/bob");
  EXPECT_FALSE(CoupledSimulation::load(std::span(bytes).first(bytes.size() - 1), make));
  bytes.back() ^= 1;
  EXPECT_EQ(errors_of(CoupledSimulation::load(bytes, make)), "damaged ");
}

TEST(CoupledSimulation, BodiesWithoutSaveCannotBeSaved) {
  CoupledSimulation coupled = coupled_with_pendulum();
  ASSERT_TRUE(coupled.attach(4, std::make_unique<ChainBody>(100)));
  EXPECT_EQ(errors_of(coupled.save()), "not_restorable /bodies/beads");
  ASSERT_TRUE(coupled.detach(4));
  EXPECT_TRUE(coupled.save());
}

TEST(CoupledSimulation, UnsuitableBodiesAreNotAttached) {
  Scene scene = bob_and_cubes();
  scene.bodies[0].fixed = true;
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies.back().name = "on an axle";
  scene.bodies.back().fixed = false;
  scene.bodies.back().axle = Axle{};
  scene.bodies.back().position = {5, 5, 5};
  scene.bodies[3].shape = make_particles({{0, 2, 0}, {0.5, 2, 0}}, 0.1);
  std::get<ParticleShape>(scene.bodies[3].shape).fixed = {1};
  CoupledSimulation coupled(Simulation::create(scene).value());
  for (const auto& [id, reason] :
       std::vector<std::pair<BodyId, std::string>>{{9, "there is no body"},
                                                   {1, "must be neither held"},
                                                   {2, "must have neither springs"},
                                                   {4, "must not have fixed particles"},
                                                   {5, "must be neither held"}}) {
    const Status attached = coupled.attach(id, make_pendulum());
    ASSERT_FALSE(attached) << id;
    EXPECT_THAT(attached.errors()[0].message, StartsWith(reason)) << id;
    EXPECT_EQ(attached.errors()[0].path, "/body");
  }
  CoupledSimulation twice = coupled_with_pendulum();
  EXPECT_FALSE(twice.attach(1, make_pendulum()));
  EXPECT_FALSE(twice.detach(2));
}

TEST(CoupledSimulation, RemovedBodiesAreDetached) {
  CoupledSimulation coupled = coupled_with_pendulum();
  ASSERT_TRUE(coupled.commands().remove_body(1));
  ASSERT_TRUE(coupled.advance(5));
  EXPECT_FALSE(coupled.detach(1));
}

/// Body that supplies an invalid motion, or throws an exception, at a time.
class FaultyBody final : public ExternalBody {
 public:
  FaultyBody(Real time, bool throws) : time_(time), throws_(throws) {}
  void start(Real /*time*/, const BodyView& /*body*/, BodyMotion& /*motion*/) override {}
  void advance(const CouplingInterval& interval, const ReceivedImpulses& /*impulses*/,
               BodyMotion& motion) override {
    if (interval.end < time_) return;
    if (throws_) throw std::runtime_error("no connection");
    motion.pose->velocity.x() = std::numeric_limits<Real>::quiet_NaN();
  }

 private:
  Real time_;
  bool throws_;
};

TEST(CoupledSimulation, InvalidMotionsEndTheCoupling) {
  CoupledSimulation coupled(Simulation::create(bob_and_cubes()).value());
  ASSERT_TRUE(coupled.attach(1, std::make_unique<FaultyBody>(0.0025, false)));
  ASSERT_TRUE(coupled.advance(2));
  for (int n = 0; n < 2; ++n) {
    EXPECT_EQ(errors_of(coupled.advance(2)), "out_of_range /bodies/bob/state/velocity");
    EXPECT_EQ(coupled.simulation().time(), 0.003);
  }
  EXPECT_FALSE(coupled.save());
}

TEST(CoupledSimulation, ExceptionsEndTheCoupling) {
  CoupledSimulation coupled(Simulation::create(bob_and_cubes()).value());
  ASSERT_TRUE(coupled.attach(1, std::make_unique<FaultyBody>(0.0015, true)));
  EXPECT_THROW(static_cast<void>(coupled.advance(5)), std::runtime_error);
  EXPECT_EQ(errors_of(coupled.advance(1)), "ended /bodies");
}

TEST(SetBodyMotion, ReplacesPositionsAndVelocities) {
  Simulation simulation = Simulation::create(bob_and_cubes()).value();
  simulation.advance(3);
  BodyMotion motion;
  motion.pose = RigidPose{{3, 0, 1}, Quat(0, 1, 0, 0), {1, 2, 3}, {0, 0, 4}};
  ASSERT_TRUE(simulation.set_body_motion(1, motion));
  const BodyView bob = *simulation.find_body(BodyId{1});
  EXPECT_EQ(bob.pose->center_of_mass, Vec3(3, 0, 1));
  EXPECT_EQ(bob.pose->orientation, Quat(0, 1, 0, 0));
  EXPECT_LE((bob.pose->angular_velocity - Vec3(0, 0, 4)).norm(), 1e-12);
  EXPECT_LE(
      (bob.velocities[0] - Vec3(1, 2, 3) - Vec3(0, 0, 4).cross(bob.positions[0] - Vec3(3, 0, 1)))
          .norm(),
      1e-12);
  const RigidMomentum momentum = *simulation.rigid_momentum(1);
  Real mass = 0;
  for (const Real particle : bob.masses) mass += particle;
  EXPECT_LE((momentum.linear - mass * Vec3(1, 2, 3)).norm(), 1e-12 * mass);
  EXPECT_FALSE(simulation.rigid_momentum(2));

  motion = {{{0, 1, 0}, {1, 1, 0}}, {{1, 0, 0}, {2, 0, 0}}, {}};
  ASSERT_TRUE(simulation.set_body_motion(4, motion));
  EXPECT_EQ(simulation.find_body(BodyId{4})->positions[1], Vec3(1, 1, 0));
  EXPECT_EQ(simulation.find_body(BodyId{4})->velocities[0], Vec3(1, 0, 0));
  motion.positions.pop_back();
  EXPECT_EQ(errors_of(simulation.set_body_motion(4, motion)), "out_of_range /state/positions");
  EXPECT_FALSE(simulation.set_body_motion(1, motion));
  EXPECT_FALSE(simulation.set_body_motion(99, motion));
}

TEST(SetBodyMotion, EndsTheForcesAtTheLastPosition) {
  Scene scene = bob_and_cubes();
  scene.bodies[0].position = {0, 0, -0.6};  // overlaps a cube
  Simulation simulation = Simulation::create(scene).value();
  simulation.advance(2);
  BodyMotion motion;
  motion.pose = RigidPose{{3, 0, 1}, Quat::Identity(), Vec3::Zero(), Vec3::Zero()};
  ASSERT_TRUE(simulation.set_body_motion(1, motion));
  simulation.advance(1);
  EXPECT_LE((simulation.bodies()[0].pose->velocity - 1e-3 * Vec3(0, 0, -9.81)).norm(), 1e-14);
}

}  // namespace
}  // namespace vat::test::coupled_simulation_test
