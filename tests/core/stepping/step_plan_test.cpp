#include "core/stepping/step_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/stepping/workspace.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::step_plan_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Scene scene_of(const std::vector<BodyDescription>& bodies, Real viscosity = 0) {
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, 1e-3,
                 {make_liquid("water", 1000, {100, viscosity, 0.1}),
                  make_liquid("oil", 800, {100, viscosity, 0.1}), make_material("solid")});
  scene.bodies = bodies;
  return scene;
}

BodyDescription body_of(const char* name, BodyKind kind, const char* material) {
  return make_body(name, kind, material, make_particles({Vec3::Zero(), 0.1 * Vec3::UnitX()}, 0.1),
                   0.05);
}

/// Returns the names of the plan's stages in order.
std::string stages_of(const Scene& scene) {
  const ForceProbe probe(scene);
  std::string names;
  for (const Stage& stage : probe.model().plan.stages) {
    names += (names.empty() ? "" : " ") + std::string(stage.name);
  }
  return names;
}

const BodyDescription kPool = body_of("pool", BodyKind::liquid, "water");
const BodyDescription kFilm = body_of("film", BodyKind::liquid, "oil");
const BodyDescription kSecondPool = body_of("second", BodyKind::liquid, "water");
const BodyDescription kBall = body_of("ball", BodyKind::rigid, "solid");
const BodyDescription kDust = body_of("dust", BodyKind::deformable, "solid");

BodyDescription make_spring_body() {
  BodyDescription body = kDust;
  body.name = "pair";
  body.springs = {{0, 1, {100, 0}, {}}};
  return body;
}

constexpr const char* kLiquid = "external_forces sort_liquid liquid_density liquid_pressure ";

TEST(StepPlan, HasTheStagesThatTheBodiesNeed) {
  const std::string liquid = kLiquid + std::string("liquid_forces_inviscid");
  EXPECT_EQ(stages_of(scene_of({})), "external_forces");
  EXPECT_EQ(stages_of(scene_of({kPool})), liquid);
  EXPECT_EQ(stages_of(scene_of({kPool, kSecondPool})), liquid);
  EXPECT_EQ(stages_of(scene_of({kPool, kFilm})), liquid + " find_contacts contacts");
  EXPECT_EQ(stages_of(scene_of({kPool}, 1)), kLiquid + std::string("liquid_forces"));
  EXPECT_EQ(stages_of(scene_of({kDust})), "external_forces");
  EXPECT_EQ(stages_of(scene_of({make_spring_body()})), "external_forces springs");
  EXPECT_EQ(stages_of(scene_of({kBall})), "pose_rigid_bodies external_forces gather_rigid_forces");
  Scene scene = scene_of({kPool});
  scene.materials[1].liquid->viscosity = 1;  // a material that no body uses
  EXPECT_EQ(stages_of(scene), liquid);
  scene = scene_of({make_spring_body()});
  scene.materials[2].self_contact = SpringConstants{100, 0};
  EXPECT_EQ(stages_of(scene), "external_forces find_contacts contacts springs");
}

TEST(StepPlan, HasTheStagesOfWallsAndLaws) {
  const auto in_vat = [](const std::vector<BodyDescription>& bodies,
                         const InterfaceConstants& law = {}, Real viscosity = 0) {
    Scene scene = scene_of(bodies, viscosity);
    scene.default_interface = law;
    scene.vat = Vat{Vec3::Constant(-1), Vec3::Constant(1), true, {}};
    return scene;
  };
  const std::vector<BodyDescription> solids = {make_spring_body(), kBall};
  EXPECT_EQ(stages_of(in_vat({kDust})), "external_forces walls");
  Scene scene = in_vat(solids, {.stiffness = 100, .restitution = 0.5});
  EXPECT_EQ(stages_of(scene),
            "pose_rigid_bodies external_forces find_contacts find_contact_mobilities contacts "
            "springs walls "
            "gather_rigid_forces");
  scene.forces.contacts = false;
  EXPECT_EQ(stages_of(scene),
            "pose_rigid_bodies external_forces find_contact_mobilities springs walls "
            "gather_rigid_forces");
  EXPECT_EQ(stages_of(in_vat(solids, {.law = InterfaceLaw::projection})),
            "pose_rigid_bodies external_forces find_contacts springs gather_rigid_forces");
  EXPECT_EQ(stages_of(in_vat({kPool, make_spring_body(), kBall}, {}, 1)),
            "pose_rigid_bodies " + std::string(kLiquid) +
                "liquid_forces find_contacts contacts springs walls gather_rigid_forces");
}

TEST(StepPlan, AsTextNamesStagesAndColumns) {
  const ForceProbe probe(scene_of({make_spring_body()}));
  EXPECT_EQ(to_text(probe.model().plan),
            "external_forces\n  reads  position velocity\n  writes force\n"
            "springs\n  reads  position velocity force\n  writes force\n");
}

TEST(StepPlan, OfASimulationFollowsItsBodies) {
  Simulation simulation = make_simulation(scene_of({kPool}));
  EXPECT_EQ(simulation.plan_text().find("contacts"), std::string::npos);
  const Result<BodyId> ball = simulation.add_body(kBall);
  ASSERT_TRUE(ball);
  EXPECT_NE(simulation.plan_text().find("contacts"), std::string::npos);
  ASSERT_TRUE(simulation.remove_body(ball.value()));
  EXPECT_EQ(simulation.plan_text().find("contacts"), std::string::npos);
}

struct RecordingObserver : StageObserver {
  void stage_begins(std::string_view stage) override { record.emplace_back(stage); }
  void stages_end() override { record.emplace_back("."); }
  std::vector<std::string> record;
};

TEST(StepPlan, ReportsEachStageToTheObserver) {
  Scene scene = scene_of({make_spring_body()});
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  Simulation simulation = make_simulation(scene);
  RecordingObserver observer;
  simulation.set_observer(&observer);
  simulation.advance(2);
  EXPECT_THAT(observer.record,
              ElementsAre("keep_state", "keep_state", "external_forces", "springs", "kick", "drift",
                          "guard", "enforce_walls", "keep_state", "external_forces", "springs",
                          "kick", "drift", "guard", "enforce_walls", "."));
  observer.record.clear();
  simulation.set_observer(nullptr);
  simulation.advance(1);
  EXPECT_THAT(observer.record, IsEmpty());
}

TEST(StepPlan, ReportsStagesUnderLocalControl) {
  Scene scene = scene_of({make_spring_body()});
  scene.numerics.integrator = IntegratorId::velocity_verlet;
  scene.numerics.control = StepControl::local;
  Simulation simulation = make_simulation(scene);
  RecordingObserver observer;
  simulation.set_observer(&observer);
  simulation.advance(1);
  for (const char* stage : {"choose_step", "choose_levels", "build_pairs", "external_forces",
                            "connections", "kick", "drift", "guard"}) {
    EXPECT_THAT(observer.record, testing::Contains(stage));
  }
  EXPECT_EQ(observer.record.back(), ".");
}

void do_nothing(StepContext&) {}

TEST(StepPlanDeathTest, AColumnIsReadOnlyOnceWritten) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  PlanBuilder builder({Column::position});
  builder.add("ok", {Column::position}, {Column::density}, &do_nothing);
  builder.add("also", {Column::density}, {Column::pressure}, &do_nothing);
  EXPECT_DEATH(builder.add("bad", {Column::velocity}, {}, &do_nothing), "written_");
}

TEST(StepPlan, ListsSubStepsOfLocalSteps) {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 0.01, {make_material("m")});
  const std::vector<Vec3> points = {{0, 0, 0}, {1, 0, 0}};
  scene.bodies = {make_body("soft", BodyKind::deformable, "m", make_particles(points, 1), 0.01),
                  make_body("stiff", BodyKind::deformable, "m", make_particles(points, 1), 0.01),
                  make_body("ball", BodyKind::rigid, "m", make_particles(points, 1), 0.01)};
  // Two masses of 1 kg on a spring k have omega^2 = 2 k / kg. The step is at most 2 / omega.
  scene.bodies[0].springs = {{0, 1, {100, 0}, 1.0}};
  scene.bodies[1].springs = {{0, 1, {2e6, 0}, 1.0}};
  scene.bodies[2].sub_steps = 5;
  EXPECT_THAT(make_simulation(scene).plan_text(), testing::Not(testing::HasSubstr("sub-steps")));
  scene.numerics.control = StepControl::local;
  const std::string plan = make_simulation(scene).plan_text();
  EXPECT_THAT(plan, testing::HasSubstr("sub-steps of soft: 1\n"));
  EXPECT_THAT(plan, testing::ContainsRegex("sub-steps of stiff: (16|32)\n"));
  EXPECT_THAT(plan, testing::HasSubstr("sub-steps of ball: 8\n"));
}

}  // namespace
}  // namespace vat::test::step_plan_test
