#include <gtest/gtest.h>

#include "core/numerics/step_limits.h"
#include "core/validation/validate.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

/// Switches of forces, and the central field.
namespace vat::test::force_switches_test {
namespace {

/// A dense liquid in shear, a stretched pair of springs, and a ball that touches both and the
/// floor.
Scene busy_scene() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-5);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {100, 1, 0.2}), make_material("wood")};
  ParticleShape pool = make_particles(make_lattice(4, 4, 4, 0.08), 1);
  for (const Vec3& p : pool.positions) pool.velocities.emplace_back(p.z(), 0, 0);
  scene.bodies = {make_body("pool", BodyKind::liquid, "water", pool, 0.05),
                  make_body("pair", BodyKind::deformable, "wood",
                            make_particles({{0, 0, 0}, {0.2, 0, 0}}, 1), 0.05),
                  make_body("ball", BodyKind::rigid, "wood", make_particles({{0, 0, 0}}, 1), 0.05)};
  scene.bodies[0].position = {0, 0, 0.15};
  scene.bodies[1].position = {0.2, 0, 0.15};
  scene.bodies[1].springs = {{0, 1, {100, 1}, 0.1}};
  scene.bodies[2].position = {0.2, 0.05, 0.04};
  scene.vat = Vat{{-1, -1, 0}, {1, 1, 1}, true, {}};
  return scene;
}

TEST(ForceSwitches, LeaveStagesOut) {
  const auto expect_no_stage = [](const std::string& name, const ForceSwitches& forces) {
    Scene scene = busy_scene();
    const std::string line = '\n' + name + '\n';
    scene.forces = forces;
    EXPECT_EQ(('\n' + to_text(ForceProbe(scene).model().plan)).find(line), std::string::npos)
        << name;
  };
  expect_no_stage("liquid_pressure", {.pressure = false});
  expect_no_stage("liquid_forces", {.viscosity = false});
  expect_no_stage("liquid_density", {.pressure = false, .viscosity = false});
  expect_no_stage("springs", {.springs = false});
  expect_no_stage("contacts", {.contacts = false});
  expect_no_stage("find_contacts", {.contacts = false});
  expect_no_stage("walls", {.walls = false});
}

/// Returns the forces of all particles, body by body.
std::vector<Vec3> forces_of(const Scene& scene) {
  ForceProbe probe(scene);
  return probe.state().forces.particle;
}

Scene with_only(bool ForceSwitches::*kept) {
  Scene scene = busy_scene();
  scene.forces = {false, false, false, false, false, false};
  scene.forces.*kept = true;
  return scene;
}

// Each switched force contributes the same part, independently of the others. In this scene no part
// is zero.
TEST(ForceSwitches, PartsAddUpToTheWhole) {
  const std::vector<Vec3> whole = forces_of(busy_scene());
  std::vector<Vec3> sum(whole.size(), Vec3::Zero());
  for (const auto kept :
       {&ForceSwitches::gravity, &ForceSwitches::pressure, &ForceSwitches::viscosity,
        &ForceSwitches::springs, &ForceSwitches::contacts, &ForceSwitches::walls}) {
    const std::vector<Vec3> part = forces_of(with_only(kept));
    Real greatest = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += part[i];
      greatest = std::max(greatest, part[i].norm());
    }
    EXPECT_GT(greatest, 1e-3);
  }
  for (std::size_t i = 0; i < sum.size(); ++i) {
    EXPECT_LT((sum[i] - whole[i]).norm(), 1e-10 * (1 + whole[i].norm())) << i;
  }
}

TEST(ForceSwitches, DiagnosticsKnowTheLiquidWithoutItsForces) {
  Scene scene = busy_scene();
  const Diagnostics with = make_simulation(scene).diagnostics();
  EXPECT_GT(with.max_density_error, 0.1);
  scene.forces.pressure = scene.forces.viscosity = false;
  const Diagnostics without = make_simulation(scene).diagnostics();
  EXPECT_EQ(without.max_density_error, with.max_density_error);
  EXPECT_EQ(without.mean_density_error, with.mean_density_error);
}

TEST(ForceSwitches, EnergyOfAForceThatIsOffIsZero) {
  Scene scene = busy_scene();
  const Diagnostics with = make_simulation(scene).diagnostics();
  EXPECT_GT(with.gravitational_energy, 1);
  EXPECT_GT(with.elastic_energy, 0.1);
  EXPECT_GT(with.contact_energy, 0.01);
  scene.forces = {false, true, true, false, false, false};
  const Diagnostics without = make_simulation(scene).diagnostics();
  EXPECT_EQ(without.gravitational_energy, 0);
  EXPECT_EQ(without.elastic_energy, 0);
  EXPECT_EQ(without.contact_energy, 0);
}

TEST(ForceSwitches, StepLimitsOmitDisabledForces) {
  Scene scene = busy_scene();
  const auto limits_of = [](const Scene& at) {
    std::vector<SampledBody> samples;
    for (const BodyDescription& body : at.bodies) {
      samples.push_back(sample_body(body, at.materials[body.material == "water" ? 0 : 1]));
    }
    return find_step_limits(at, samples);
  };
  EXPECT_FALSE(limits_of(scene).empty());
  scene.forces = {true, false, false, false, false, false};
  EXPECT_TRUE(limits_of(scene).empty());
}

TEST(CentralField, PullsInProportionToTheDistance) {
  Scene scene = with_only(&ForceSwitches::gravity);
  scene.gravity = {1, 2, 3};
  scene.central_field = CentralField{{0.5, -1, 2}, 3};
  const ForceProbe probe(scene);
  const Vec3 place(0.2, 0.05, 0.04);  // position of the ball
  const Vec3 expected = Vec3(1, 2, 3) - 9 * (place - Vec3(0.5, -1, 2));
  EXPECT_LT((probe.force(2) - expected).norm(), 1e-13);
  const Real of_field = 0.5 * 9 * (place - scene.central_field->center).squaredNorm();
  scene.bodies = {scene.bodies[2]};
  EXPECT_NEAR(make_simulation(scene).diagnostics().gravitational_energy,
              of_field - place.dot(scene.gravity), 1e-13);
  scene.forces.gravity = false;
  EXPECT_EQ(ForceProbe(scene).force(0), Vec3(0, 0, 0));
}

}  // namespace
}  // namespace vat::test::force_switches_test
