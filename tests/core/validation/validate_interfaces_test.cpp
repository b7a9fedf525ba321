#include <gtest/gtest.h>

#include <functional>

#include "core/simulation/simulation.h"
#include "core/validation/validate.h"
#include "tests/support/errors.h"
#include "tests/support/scenes.h"

// Required members of each interface law.

namespace vat::test::validate_interfaces_test {
namespace {

/// A scene with separate bodies of each kind.
Scene valid_scene() {
  Scene scene = make_scene(
      IntegratorId::velocity_verlet, 1e-3,
      {make_liquid("water", 1000, {100, 0, 0.1}), make_material("rubber"), make_material("wood")});
  const ParticleShape point = make_particles({{0, 0, 0}}, 1);
  scene.bodies = {make_body("drop", BodyKind::liquid, "water", point, 0.05),
                  make_body("bead", BodyKind::deformable, "rubber", point, 0.05),
                  make_body("ball", BodyKind::rigid, "wood", point, 0.05)};
  for (std::size_t b = 0; b < 3; ++b) scene.bodies[b].position.x() = 0.2 * static_cast<Real>(b);
  scene.vat = Vat{Vec3::Constant(-1), Vec3::Constant(1), true, {}, {}};
  return scene;
}

void add_interface(Scene& scene, const char* first, const char* second,
                   const InterfaceConstants& constants) {
  scene.interfaces.push_back(InterfaceDescription{{first, second}, constants, {}});
}

constexpr InterfaceConstants kSph{.law = InterfaceLaw::sph};
constexpr InterfaceConstants kProjection{.law = InterfaceLaw::projection};

struct Mistake {
  const char* error;
  std::function<void(Scene&)> make;
};

const Mistake kMistakes[] = {
    {"out_of_range /default_interface/restitution",
     [](Scene& s) { s.default_interface = {.stiffness = 1, .restitution = 0.049}; }},
    {"out_of_range /default_interface/restitution",
     [](Scene& s) { s.default_interface = {.law = InterfaceLaw::projection, .restitution = 1.1}; }},
    {"not_allowed /default_interface/damping",
     [](Scene& s) { s.default_interface = {.stiffness = 1, .damping = 1, .restitution = 0.5}; }},
    {"not_allowed /default_interface/restitution",
     [](Scene& s) {
       s.default_interface = {.stiffness = 1, .restitution = 0.5};
       s.numerics.control = StepControl::local;
     }},
    {"out_of_range /default_interface/reach", [](Scene& s) { s.default_interface.reach = 1; }},
    {"out_of_range /default_interface/reach", [](Scene& s) { s.default_interface.reach = 4.1; }},
    {"not_allowed /default_interface/law", [](Scene& s) { s.default_interface = kSph; }},
    {"not_allowed /default_interface/law",
     [](Scene& s) {
       s.default_interface = kProjection;
       s.numerics.control = StepControl::local;
     }},
    {"not_allowed /default_interface/law",
     [](Scene& s) {
       s.default_interface = kProjection;
       s.numerics.integrator = IntegratorId::runge_kutta_4;
     }},
    {"not_allowed /interfaces/0/law",
     [](Scene& s) {
       add_interface(s, "wood", "vat", kProjection);
       s.numerics.integrator = IntegratorId::heun;
     }},
    {"not_allowed /interfaces/0/law", [](Scene& s) { add_interface(s, "water", "wood", kSph); }},
    {"not_allowed /interfaces/0/law",
     [](Scene& s) {
       s.pressure_solver = PressureSolver::tait;
       add_interface(s, "rubber", "wood", kSph);
     }},
    {"not_allowed /interfaces/0/law", [](Scene& s) {
       s.pressure_solver = PressureSolver::tait;
       add_interface(s, "vat", "wood", kSph);
     }}};

TEST(ValidateInterfaces, FindsEveryMistakeAlone) {
  ASSERT_EQ(errors_of(find_errors(valid_scene())), "");
  for (const auto& [error, make] : kMistakes) {
    Scene scene = valid_scene();
    make(scene);
    EXPECT_EQ(errors_of(find_errors(scene)), error);
  }
}

TEST(ValidateInterfaces, AllowEverySuitableLaw) {
  Scene scene = valid_scene();
  scene.pressure_solver = PressureSolver::tait;
  scene.default_interface = {.stiffness = 1, .restitution = 0.05};
  scene.interfaces = {
      {{"water", "vat"}, kSph, {}},
      {{"wood", "water"}, kSph, {}},
      {{"wood", "vat"}, {.law = InterfaceLaw::projection, .restitution = 0}, {}},
      {{"wood", "rubber"}, {.stiffness = 1, .law = InterfaceLaw::lennard_jones, .reach = 4}, {}}};
  EXPECT_TRUE(find_errors(scene).empty());
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  scene.numerics.control = StepControl::adaptive;
  EXPECT_TRUE(find_errors(scene).empty());
}

TEST(ValidateInterfaces, AccuracyChoosesNumericsThatCanProject) {
  Scene scene = valid_scene();
  scene.default_interface = kProjection;
  scene.numerics.integrator = IntegratorId::runge_kutta_4;
  scene.numerics.accuracy = 1e-3;
  EXPECT_TRUE(find_errors(scene).empty());
  const Numerics chosen = make_simulation(scene).scene().numerics;
  EXPECT_EQ(chosen.integrator, IntegratorId::velocity_verlet);
  EXPECT_EQ(chosen.control, StepControl::adaptive);
}

TEST(ValidateInterfaces, ApplyToAddedBodies) {
  Scene scene = valid_scene();
  scene.pressure_solver = PressureSolver::tait;
  scene.interfaces = {{{"water", "vat"}, kSph, {}}};
  Simulation simulation = make_simulation(scene);
  BodyDescription solid = scene.bodies[2];
  solid.name = "cork";
  solid.material = "water";
  solid.position.z() = 0.5;
  EXPECT_EQ(errors_of(simulation.add_body(solid)), "not_allowed /body/material");

  scene.numerics.integrator = IntegratorId::heun;
  EXPECT_EQ(errors_of(make_simulation(scene).set_interface({{"wood", "vat"}, kProjection, {}})),
            "not_allowed /interface/law");
}

}  // namespace
}  // namespace vat::test::validate_interfaces_test
