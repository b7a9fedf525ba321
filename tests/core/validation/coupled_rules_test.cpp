#include <gtest/gtest.h>

#include "core/validation/validate.h"
#include "tests/support/errors.h"
#include "tests/support/scenes.h"

// Unsupported features of liquids in which walls and solids take part.

namespace vat::test::coupled_rules_test {
namespace {

BodyDescription make_drop() {
  return make_body("drop", BodyKind::liquid, "water", make_particles({{0, 0, 0}}, 1), 0.05);
}

Scene make_coupled() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.pressure_solver = PressureSolver::tait;
  scene.materials = {make_liquid("water", 1000, {100, 1, 0.1})};
  return scene;
}

TEST(CoupledLiquids, HaveLocalStepsWithTheIntegratorOfTheirSolver) {
  Scene scene = make_coupled();
  scene.numerics.control = StepControl::local;
  EXPECT_EQ(errors_of(find_body_errors(scene, make_drop(), "/body")), "");
  scene.bodies = {make_drop()};
  EXPECT_EQ(errors_of(find_errors(scene)), "");
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /numerics/control");
  scene.pressure_solver = PressureSolver::incompressible;
  EXPECT_EQ(errors_of(find_errors(scene)), "");
}

TEST(CoupledLiquids, HaveSurfacesOfCurvatureByWendlandsKernel) {
  Scene scene = make_coupled();
  scene.materials[0].liquid->surface_tension = 0.073;
  EXPECT_EQ(errors_of(find_errors(scene)), "");
  scene.kernel = KernelId::cubic_spline;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /materials/0/liquid/surface_tension");
  scene.kernel = KernelId::wendland_c2;
  scene.pressure_solver = PressureSolver::gas;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /materials/0/liquid/surface_tension");
}

TEST(CoupledLiquids, AttractThemselvesIfTensionIsAllowed) {
  Scene scene = make_coupled();
  scene.surface_model = SurfaceModel::cohesion;
  scene.materials[0].liquid->surface_tension = 0.073;
  EXPECT_EQ(errors_of(find_errors(scene)), "");
  scene.pressure_solver = PressureSolver::incompressible;
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /materials/0/liquid/surface_tension");
}

TEST(CoupledLiquids, MeetWallsAndBodiesAtAnglesThatTheirModelHas) {
  Scene scene = make_coupled();
  scene.materials.push_back(make_material("stone"));
  scene.interfaces = {{{"water", "stone"}, {}, {}, 40}};
  EXPECT_EQ(errors_of(find_errors(scene)), "not_allowed /interfaces/0/contact_angle");
  scene.surface_model = SurfaceModel::cohesion;
  EXPECT_EQ(errors_of(find_errors(scene)), "");
  for (const Real angle : {29.0, 136.0}) {
    scene.interfaces[0].contact_angle = angle;
    EXPECT_EQ(errors_of(find_errors(scene)), "out_of_range /interfaces/0/contact_angle");
  }
}

// Cohesion reaches twice as far as the support radius, and needs three spacings in two dimensions.
TEST(CoupledLiquids, ThatAttractThemselvesNeedRoomAndNeighbours) {
  Scene scene = make_coupled();
  scene.surface_model = SurfaceModel::cohesion;
  scene.materials[0].liquid->surface_tension = 0.073;
  scene.dimensions = 2;
  BodyDescription drop{"drop", BodyKind::liquid, "water", SphereShape{Vec3::Zero(), 0.15}, 0.033};
  scene.bodies = {drop};
  EXPECT_EQ(errors_of(find_errors(scene)), "");
  scene.periodic = Periodicity{{-0.19, -1, -1}, {0.19, 1, 1}, {true, false, false}};
  EXPECT_NE(errors_of(find_errors(scene)), "");
  scene.periodic = Periodicity{{-0.21, -1, -1}, {0.21, 1, 1}, {true, false, false}};
  EXPECT_EQ(errors_of(find_errors(scene)), "");
  scene.bodies[0].spacing = 0.036;
  EXPECT_EQ(errors_of(find_errors(scene)), "out_of_range /bodies/0/spacing");
  scene.surface_model = SurfaceModel::curvature;
  EXPECT_EQ(errors_of(find_errors(scene)), "");
}

TEST(CoupledLiquids, ShareOneSupportRadius) {
  Scene scene = make_coupled();
  scene.materials.push_back(make_liquid("oil", 900, {100, 1, 0.2}));
  EXPECT_EQ(errors_of(find_errors(scene)), "out_of_range /materials/1/liquid/support_radius");
  scene.pressure_solver = PressureSolver::gas;
  EXPECT_EQ(errors_of(find_errors(scene)), "");
}

TEST(CoupledLiquids, ThatAttractThemselvesNeedRoomWhereverTheyAreListed) {
  Scene scene = make_coupled();
  scene.surface_model = SurfaceModel::cohesion;
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "oil";
  scene.materials[0].liquid->surface_tension = 0.1;
  scene.materials[0].liquid->support_radius = scene.materials[1].liquid->support_radius = 0.31;
  scene.bodies = {make_drop(), make_drop()};
  scene.bodies[0].name = "slick";
  scene.bodies[0].material = "oil";
  std::get<ParticleShape>(scene.bodies[0].shape).positions = {{0.2, 0, 0}};
  scene.periodic = Periodicity{{0, 0, 0}, {1.2, 0, 0}, {true, false, false}};
  for (int order = 0; order < 2; ++order) {
    EXPECT_EQ(errors_of(find_errors(scene)), "out_of_range /periodic/max");
    std::swap(scene.bodies[0], scene.bodies[1]);
  }
  scene.periodic->max.x() = 1.3;
  EXPECT_EQ(errors_of(find_errors(scene)), "");
}

}  // namespace
}  // namespace vat::test::coupled_rules_test
