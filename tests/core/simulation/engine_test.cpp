#include <gtest/gtest.h>

#include <memory>

#include "core/stepping/step_engine.h"
#include "tests/support/errors.h"
#include "tests/support/shaken_vat.h"

// How a simulation uses the engine of a device, with an engine in place of a device.

namespace vat::test::engine_test {
namespace {

/// An engine that records its calls. Its steps leave the particles where they are.
struct Recorded {
  int binds = 0;
  int reads = 0;
  std::vector<bool> continued{};  ///< by advance()
  bool refuses = false;
  bool is_lost = false;
  bool is_bindable = true;
};

class FakeEngine : public StepEngine {
 public:
  explicit FakeEngine(Recorded& record) : record_(record) {}
  std::string_view arithmetic() const override { return "fake"; }
  Status bind(std::shared_ptr<const Model> model, const GuardBounds&) override {
    ++record_.binds;
    model_ = std::move(model);
    if (record_.is_lost) return Error{"device_failed", "/device", "lost"};
    if (!record_.is_bindable) return Error{"not_on_device", "/bodies/1/kind", "no solids"};
    return {};
  }
  Result<bool> advance(const EngineInput& input, std::uint32_t steps) override {
    record_.continued.push_back(input.continues);
    if (record_.is_lost) return Error{"device_failed", "/device", "lost"};
    if (!record_.refuses) input.report.steps += steps;
    return !record_.refuses;
  }
  Status read(State&) override {
    ++record_.reads;
    if (record_.is_lost) return Error{"device_failed", "/device", "lost"};
    return {};
  }
  Status read_motions(BodyMotions& motions) override {
    if (record_.is_lost) return Error{"device_failed", "/device", "lost"};
    motions.rigid = initial_state(*model_).now.rigid;
    motions.particles.resize(model_->bodies.size());
    return {};
  }

 private:
  std::shared_ptr<const Model> model_;
  Recorded& record_;
};

Scene make_scene_of_test() {
  return make_shaken_vat(IntegratorId::velocity_verlet);
}

Simulation make_with(Recorded& record) {
  Simulation simulation = make_simulation(make_scene_of_test());
  EXPECT_TRUE(simulation.set_engine(std::make_unique<FakeEngine>(record)).ok());
  return simulation;
}

std::uint64_t hash_on_cpu(std::uint32_t steps) {
  Simulation simulation = make_advanced(make_scene_of_test(), steps);
  return simulation.state_hash();
}

TEST(Engine, TakesTheStepsAndReadsTheStateOnlyIfNeeded) {
  Recorded record;
  Simulation simulation = make_with(record);
  EXPECT_EQ(simulation.arithmetic(), "fake");
  EXPECT_EQ(simulation.advance(3).device_steps, 3U);
  EXPECT_EQ(simulation.advance(2).device_steps, 2U);
  EXPECT_DOUBLE_EQ(simulation.time(), 5 * simulation.step_size());
  EXPECT_EQ(record.reads, 0);
  EXPECT_EQ(simulation.bodies().size(), 3U);
  static_cast<void>(std::as_const(simulation).state_hash());
  EXPECT_EQ(record.reads, 1);
  simulation.advance(1);
  EXPECT_EQ(record.continued, (std::vector{false, true, true}));
  EXPECT_EQ(record.binds, 1);
}

TEST(Engine, StartsFromTheStateOfACommand) {
  Recorded record;
  Simulation simulation = make_with(record);
  simulation.advance(1);
  ASSERT_TRUE(simulation.set_gravity({0, 0, -1}).ok());
  simulation.advance(1);
  EXPECT_EQ(record.continued, (std::vector{false, false}));
  EXPECT_EQ(record.reads, 1);
}

TEST(Engine, LeavesRefusedStepsToTheCpu) {
  Recorded record{.refuses = true};
  Simulation simulation = make_with(record);
  const AdvanceReport report = simulation.advance(4);
  EXPECT_EQ(report.device_steps, 0U);
  EXPECT_FALSE(report.device_error.has_value());
  EXPECT_EQ(simulation.state_hash(), hash_on_cpu(4));
  EXPECT_EQ(simulation.arithmetic(), "fake");
}

TEST(Engine, IsNotUsedAfterAFailure) {
  Recorded record;
  Simulation simulation = make_with(record);
  record.is_lost = true;
  const AdvanceReport report = simulation.advance(4);
  ASSERT_TRUE(report.device_error.has_value());
  EXPECT_EQ(report.device_error->code, "device_failed");
  EXPECT_FALSE(simulation.advance(2).device_error.has_value());
  EXPECT_EQ(record.continued.size(), 1U);
  EXPECT_EQ(simulation.state_hash(), hash_on_cpu(6));
}

TEST(Engine, RepeatsUnreadStepsOnTheCpuIfTheDeviceIsLost) {
  Recorded record;
  Simulation simulation = make_with(record);
  simulation.advance(3);
  simulation.advance(2);
  record.is_lost = true;
  EXPECT_EQ(simulation.state_hash(), hash_on_cpu(5));
  const AdvanceReport report = simulation.advance(1);
  ASSERT_TRUE(report.device_error.has_value());
  EXPECT_EQ(simulation.state_hash(), hash_on_cpu(6));
}

// A layer enters before the first step, and has entered when the CPU repeats this step.
TEST(Engine, RepeatsNoInflowIfTheDeviceIsLost) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.materials = {make_liquid("water", 1000, {100, 0.1, 0.1})};
  scene.bodies = {BodyDescription{"pool", BodyKind::liquid, "water",
                                  BoxShape{Vec3::Zero(), {0.2, 0.2, 0.2}}, 0.05}};
  Emitter tap;
  tap.name = "tap";
  tap.body = "pool";
  tap.position = {0, 0, 0.3};
  tap.radius = 0.05;
  tap.speed = 0.1;
  tap.most_particles = 1000;
  scene.emitters = {tap};
  Simulation cpu = make_advanced(scene, 5);
  ASSERT_GT(cpu.diagnostics().emitted_particles, 0U);
  Recorded record;
  Simulation simulation = make_simulation(scene);
  ASSERT_TRUE(simulation.set_engine(std::make_unique<FakeEngine>(record)).ok());
  EXPECT_EQ(simulation.advance(3).device_steps, 3U);
  simulation.advance(2);
  record.is_lost = true;
  EXPECT_EQ(simulation.state_hash(), cpu.state_hash());
}

/// Returns a scene with sleeping in which a body is at rest, also without steps.
Scene make_scene_at_rest() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.numerics.tick = 4e-3;
  scene.materials = {make_material("stone", 1000)};
  scene.bodies = {
      make_body("stone", BodyKind::rigid, "stone", make_particles({Vec3::Zero()}, 1), 0.05)};
  scene.sleeping = Sleeping{0.01, 0.1};
  return scene;
}

// Each check for sleep counts once, also if the CPU repeats a step.
TEST(Engine, CountsEachCheckForSleepOnce) {
  struct Case {
    const char* name;
    bool refuses;
    bool is_lost;
    std::uint32_t steps;
  };
  for (const Case& one :
       {Case{"refused", true, false, 4}, Case{"lost", false, true, 4},
        Case{"refused in parts", true, false, 10}, Case{"lost in parts", false, true, 10}}) {
    SCOPED_TRACE(one.name);
    Simulation cpu = make_advanced(make_scene_at_rest(), 8 + one.steps);
    Recorded record;
    Simulation simulation = make_simulation(make_scene_at_rest());
    ASSERT_TRUE(simulation.set_engine(std::make_unique<FakeEngine>(record)).ok());
    EXPECT_EQ(simulation.advance(4).device_steps, 4U);
    EXPECT_EQ(simulation.advance(4).device_steps, 4U);
    record.refuses = one.refuses;
    record.is_lost = one.is_lost;
    simulation.advance(one.steps);
    EXPECT_EQ(std::as_const(simulation).state_hash(), cpu.state_hash());
  }
}

TEST(Engine, StepsNoBodyThatSleeps) {
  Recorded record;
  Simulation simulation = make_simulation(make_scene_at_rest());
  ASSERT_TRUE(simulation.set_engine(std::make_unique<FakeEngine>(record)).ok());
  simulation.advance(400);
  EXPECT_EQ(simulation.sleeping_body_count(), 1U);
  const std::size_t calls = record.continued.size();
  simulation.advance(400);
  EXPECT_EQ(record.continued.size(), calls);
  EXPECT_EQ(record.binds, 1);
}

TEST(Engine, IsRefusedWithTheErrorsOfTheScene) {
  Recorded record{.is_bindable = false};
  Simulation simulation = make_simulation(make_scene_of_test());
  EXPECT_EQ(errors_of(simulation.set_engine(std::make_unique<FakeEngine>(record))),
            "not_on_device /bodies/1/kind");
  EXPECT_EQ(simulation.advance(1).device_steps, 0U);
}

TEST(Engine, IsNotUsedWhileTheSceneHasAFeatureThatItLacks) {
  Recorded record;
  Simulation simulation = make_with(record);
  record.is_bindable = false;
  ASSERT_TRUE(simulation.set_gravity({0, 0, -1}).ok());
  const AdvanceReport report = simulation.advance(1);
  ASSERT_TRUE(report.device_error.has_value());
  EXPECT_EQ(report.device_error->code, "not_on_device");
  EXPECT_EQ(report.steps, 1U);
  EXPECT_EQ(report.device_steps, 0U);
  // The engine is asked, and the error told, only once for a scene.
  EXPECT_FALSE(simulation.advance(1).device_error.has_value());
  EXPECT_EQ(record.binds, 2);
  ASSERT_TRUE(simulation.set_gravity({0, 0, -2}).ok());
  EXPECT_FALSE(simulation.advance(1).device_error.has_value());
  EXPECT_EQ(record.binds, 3);
  record.is_bindable = true;
  ASSERT_TRUE(simulation.set_gravity({0, 0, -3}).ok());
  EXPECT_EQ(simulation.advance(1).device_steps, 1U);
  EXPECT_TRUE(simulation.has_engine());
}

TEST(Engine, IsResumedWithAFeatureThatItLacks) {
  Recorded record{.is_bindable = false};
  Simulation simulation = make_simulation(make_scene_of_test());
  ASSERT_TRUE(simulation.resume_engine(std::make_unique<FakeEngine>(record)).ok());
  const AdvanceReport report = simulation.advance(1);
  EXPECT_EQ(report.device_steps, 0U);
  EXPECT_FALSE(report.device_error.has_value());
  record.is_bindable = true;
  ASSERT_TRUE(simulation.set_gravity({0, 0, -1}).ok());
  EXPECT_EQ(simulation.advance(1).device_steps, 1U);
}

TEST(Engine, IsNotResumedIfItsDeviceFails) {
  Recorded record{.is_lost = true};
  Simulation simulation = make_simulation(make_scene_of_test());
  EXPECT_EQ(errors_of(simulation.resume_engine(std::make_unique<FakeEngine>(record))),
            "device_failed /device");
  EXPECT_FALSE(simulation.has_engine());
}

}  // namespace
}  // namespace vat::test::engine_test
