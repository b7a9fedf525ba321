#include <gtest/gtest.h>

#include "core/model/compile.h"
#include "core/stepping/step_plan.h"
#include "tests/support/scenes.h"

// Samples of liquids are released, and computed again on demand.

namespace vat::test::forgotten_samples_test {
namespace {

Scene make_mixture() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3,
                           {make_liquid("water", 1000, {100, 0, 0.2}), make_material("wood", 500)});
  BodyDescription pool = make_body("pool", BodyKind::liquid, "water", {}, 0.05);
  pool.shape = BoxShape{Vec3::Zero(), Vec3::Constant(0.5)};
  pool.spacing = 0.1;
  pool.velocity = {1, 2, 3};
  BodyDescription block = pool;
  block.name = "block";
  block.kind = BodyKind::rigid;
  block.material = "wood";
  block.shape = BoxShape{Vec3(2, 0, 0), Vec3::Constant(0.5)};
  scene.bodies = {pool, block};
  return scene;
}

TEST(ForgottenSamples, AreMadeAgainTheSame) {
  const std::shared_ptr<Model> model = compile(make_mixture(), {1, 2}, {nullptr, nullptr});
  const std::shared_ptr<const SampledBody> before = model->bodies[0].sample;
  ASSERT_EQ(before->positions.size(), 125U);
  forget_samples(*model);
  EXPECT_EQ(model->bodies[0].sample, nullptr);
  EXPECT_NE(model->bodies[1].sample, nullptr);
  const std::shared_ptr<const SampledBody> again = sample_of(*model, 0);
  EXPECT_NE(again, before);
  EXPECT_EQ(again->positions, before->positions);
  EXPECT_EQ(again->velocities, before->velocities);
  EXPECT_EQ(again->masses, before->masses);
  EXPECT_EQ(again->radii, before->radii);
  EXPECT_EQ(sample_of(*model, 1), model->bodies[1].sample);
}

// Given samples cannot be computed again.
TEST(ForgottenSamples, AreNotThoseThatWereGiven) {
  const auto given = std::make_shared<const SampledBody>(
      *sample_of(*compile(make_mixture(), {1, 2}, {nullptr, nullptr}), 0));
  const std::shared_ptr<Model> model = compile(make_mixture(), {1, 2}, {given, nullptr});
  forget_samples(*model);
  EXPECT_EQ(model->bodies[0].sample, given);
}

TEST(ForgottenSamples, AreNotThoseOfScenesThatFlow) {
  Scene scene = make_mixture();
  scene.drains = {{.name = "sink", .min = {5, 5, 5}, .max = {6, 6, 6}}};
  const std::shared_ptr<Model> model = compile(scene, {1, 2}, {nullptr, nullptr});
  forget_samples(*model);
  EXPECT_NE(model->bodies[0].sample, nullptr);
}

}  // namespace
}  // namespace vat::test::forgotten_samples_test
