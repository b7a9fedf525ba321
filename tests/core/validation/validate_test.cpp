#include "core/validation/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/limits.h"
#include "core/simulation/simulation.h"
#include "core/validation/validate_parts.h"
#include "tests/core/sampling/mesh_shapes.h"
#include "tests/support/errors.h"

namespace vat::test::validate_test {
namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

/// A valid scene with a body of each kind and an element in every list.
Scene valid_scene() {
  Scene scene;
  scene.name = "valid";
  scene.materials.resize(3);
  scene.materials[0].name = "water";
  scene.materials[0].liquid = LiquidConstants{100, 1, 0.1};
  scene.materials[1].name = "rubber";
  scene.materials[1].springs = LatticeSprings{{{100, 1}}, {{50, 1}}, {{20, 1}}};
  scene.materials[1].self_contact = SpringConstants{100, 1};
  scene.materials[2].name = "wood";
  scene.interfaces = {{{"water", "vat"}, {100, 1}, 0.05}, {{"wood", "wood"}, {100, 1}, {}}};
  scene.vat = Vat{{0, 0, 0}, {1, 1, 1}, true, SlideMotion{{1, 0, 0}, 0.1, 1}};
  scene.bodies.resize(4);
  scene.bodies[0] = {"pool", BodyKind::liquid, "water", BoxShape{{0.5, 0.5, 0.1}, {1, 1, 0.2}},
                     0.05};
  scene.bodies[1] = {"cube", BodyKind::deformable, "rubber",
                     BoxShape{{0.5, 0.5, 0.4}, {0.2, 0.2, 0.2}}, 0.05};
  scene.bodies[2] = {"ball", BodyKind::rigid, "wood", SphereShape{{0.5, 0.5, 0.8}, 0.1}, 0.05};
  scene.bodies[3].name = "pendulum";
  scene.bodies[3].kind = BodyKind::deformable;
  scene.bodies[3].material = "wood";
  scene.bodies[3].shape =
      ParticleShape{{{0.1, 0.1, 0.9}, {0.1, 0.1, 0.7}}, {}, {1, 1}, {0.01, 0.01}, {0}};
  scene.bodies[3].springs = {{0, 1, {100, 0}, {}}};
  return scene;
}

ParticleShape& particles(Scene& scene) {
  return std::get<ParticleShape>(scene.bodies[3].shape);
}

TEST(Validate, FindsNothingWrongInAValidScene) {
  const Errors errors = find_errors(valid_scene());
  EXPECT_TRUE(errors.empty()) << errors.front().path << ' ' << errors.front().message;
  EXPECT_TRUE(find_errors(Scene{}).empty());
}

MeshShape ball_mesh() {
  return box_mesh({0.4, 0.4, 0.7}, {0.6, 0.6, 0.9});
}

struct Mistake {
  const char* error;
  std::function<void(Scene&)> make;
};

const Mistake kMistakes[] = {
    {"bad_text /name", [](Scene& s) { s.name.assign(kMaxNameLength + 1, 'x'); }},
    {"bad_text /title", [](Scene& s) { s.title.assign(kMaxTextLength + 1, 'x'); }},
    {"out_of_range /gravity", [](Scene& s) { s.gravity.y() = kNan; }},
    {"out_of_range /gravity", [](Scene& s) { s.gravity.z() = -1001; }},
    {"out_of_range /default_interface/stiffness",
     [](Scene& s) { s.default_interface.stiffness = -1; }},
    {"out_of_range /default_interface/friction",
     [](Scene& s) { s.default_interface.friction = -0.1; }},
    {"out_of_range /default_interface/friction",
     [](Scene& s) { s.default_interface.friction = kNan; }},
    {"out_of_range /vat/min", [](Scene& s) { s.vat->min.x() = -kInfinity; }},
    {"out_of_range /vat/motion/axis", [](Scene& s) { s.vat->motion->axis.setZero(); }},
    {"out_of_range /vat/motion/stroke", [](Scene& s) { s.vat->motion->stroke = kNan; }},
    {"out_of_range /vat/motion/period", [](Scene& s) { s.vat->motion->period = 0; }},
    {"out_of_range /vat/motion/period", [](Scene& s) { s.vat->motion->stroke = 1e5; }},
    {"out_of_range /sleeping/speed", [](Scene& s) { s.sleeping.emplace().speed = 0; }},
    {"out_of_range /sleeping/speed", [](Scene& s) { s.sleeping.emplace().speed = 1.5; }},
    {"out_of_range /sleeping/after", [](Scene& s) { s.sleeping.emplace().after = 0; }},
    {"out_of_range /sleeping/after", [](Scene& s) { s.sleeping.emplace().after = kNan; }},
    {"out_of_range /numerics/step", [](Scene& s) { s.numerics.step = 0; }},
    {"out_of_range /numerics/tick", [](Scene& s) { s.numerics.tick = 2; }},
    {"out_of_range /numerics/tick", [](Scene& s) { s.numerics.tick = 0.0205; }},
    {"out_of_range /numerics/tick", [](Scene& s) { s.numerics.step = 0.1; }},
    {"out_of_range /numerics/tick", [](Scene& s) { s.numerics.step = 1e-6; }},
    {"duplicate /materials/2/name",
     [](Scene& s) {
       s.materials.push_back(s.materials[2]);
       std::swap(s.materials[2], s.materials[3]);
       s.materials[3].name = "stone";
       s.materials[2].name = "rubber";
       s.bodies[2].material = s.bodies[3].material = "stone";
       s.interfaces[1].materials = {"stone", "stone"};
     }},
    {"reserved_name /materials/3/name",
     [](Scene& s) {
       s.materials.push_back(s.materials[2]);
       s.materials.back().name = "vat";
     }},
    {"bad_text /materials/3/name", [](Scene& s) { s.materials.emplace_back(); }},
    {"out_of_range /materials/0/density", [](Scene& s) { s.materials[0].density = 0; }},
    {"out_of_range /materials/0/liquid/stiffness",
     [](Scene& s) { s.materials[0].liquid->stiffness = -1; }},
    {"out_of_range /materials/0/liquid/viscosity",
     [](Scene& s) { s.materials[0].liquid->viscosity = kInfinity; }},
    {"out_of_range /materials/0/liquid/support_radius",
     [](Scene& s) { s.materials[0].liquid->support_radius = 0; }},
    {"out_of_range /materials/1/springs/shear/stiffness",
     [](Scene& s) { s.materials[1].springs->shear->stiffness = -1; }},
    {"out_of_range /materials/1/springs/bend/damping",
     [](Scene& s) { s.materials[1].springs->bend->damping = kNan; }},
    {"out_of_range /materials/1/self_contact/damping",
     [](Scene& s) { s.materials[1].self_contact->damping = -1; }},
    {"too_many /materials",
     [](Scene& s) {
       while (s.materials.size() <= kMaxMaterials) {
         s.materials.push_back(s.materials[2]);
         s.materials.back().name = "m" + std::to_string(s.materials.size());
       }
     }},
    {"unknown_name /interfaces/0/materials/0",
     [](Scene& s) { s.interfaces[0].materials[0] = "oil"; }},
    {"unknown_name /interfaces/0/materials",
     [](Scene& s) { s.interfaces[0].materials[0] = "vat"; }},
    {"duplicate /interfaces/2/materials",
     [](Scene& s) {
       s.interfaces.push_back(s.interfaces[0]);
       std::swap(s.interfaces[2].materials[0], s.interfaces[2].materials[1]);
     }},
    {"out_of_range /interfaces/1/stiffness",
     [](Scene& s) { s.interfaces[1].constants.stiffness = 1e13; }},
    {"out_of_range /interfaces/0/friction",
     [](Scene& s) { s.interfaces[0].constants.friction = 10.1; }},
    {"out_of_range /interfaces/0/threshold",
     [](Scene& s) { s.interfaces[0].threshold = 8.1 * 0.05; }},
    {"out_of_range /interfaces/0/threshold", [](Scene& s) { s.interfaces[0].threshold = 0; }},
    {"duplicate /bodies/1/name", [](Scene& s) { s.bodies[1].name = "pool"; }},
    {"bad_text /bodies/1/name", [](Scene& s) { s.bodies[1].name = ""; }},
    {"unknown_name /bodies/1/material", [](Scene& s) { s.bodies[1].material = "x"; }},
    {"not_liquid /bodies/0/material", [](Scene& s) { s.bodies[0].material = "wood"; }},
    {"out_of_range /bodies/2/spacing", [](Scene& s) { s.bodies[2].spacing = kNan; }},
    {"too_many /bodies/2/spacing", [](Scene& s) { s.bodies[2].spacing = 1e-5; }},
    {"out_of_range /bodies/2/mass", [](Scene& s) { s.bodies[2].mass = 0; }},
    {"out_of_range /bodies/2/radius", [](Scene& s) { s.bodies[2].radius = -1; }},
    {"out_of_range /bodies/0/spacing",
     [](Scene& s) { s.materials[0].liquid->support_radius = 8.1 * 0.05; }},
    {"out_of_range /bodies/1/radius", [](Scene& s) { s.bodies[1].radius = 4.1 * 0.05; }},
    {"unknown_name /bodies/1/material",
     [](Scene& s) {
       s.bodies[1].material = "x";
       s.bodies[1].springs = s.bodies[3].springs;
     }},
    {"out_of_range /bodies/2/orientation",
     [](Scene& s) { s.bodies[2].orientation = Quat(0, 0, 0, 0); }},
    {"out_of_range /bodies/2/velocity", [](Scene& s) { s.bodies[2].velocity.x() = 1e5; }},
    {"out_of_range /bodies/2/angular_velocity",
     [](Scene& s) { s.bodies[2].angular_velocity.x() = kNan; }},
    {"outside_vat /bodies/2", [](Scene& s) { s.bodies[2].position.x() = 0.5; }},
    {"outside_vat /bodies/2", [](Scene& s) { s.bodies[2].position.z() = 0.3; }},
    {"not_allowed /bodies/2/springs", [](Scene& s) { s.bodies[2].springs = s.bodies[3].springs; }},
    {"out_of_range /bodies/2/shape/radius",
     [](Scene& s) { std::get<SphereShape>(s.bodies[2].shape).radius = -1; }},
    {"out_of_range /bodies/1/shape/size",
     [](Scene& s) { std::get<BoxShape>(s.bodies[1].shape).size.y() = 0; }},
    {"out_of_range /bodies/2/shape/axis",
     [](Scene& s) {
       s.bodies[2].shape = CylinderShape{{0.5, 0.5, 0.8}, {0, 0, 0}, 0.1, 0.1};
     }},
    {"open_mesh /bodies/2/shape",
     [](Scene& s) {
       MeshShape mesh = ball_mesh();
       mesh.triangles.pop_back();
       s.bodies[2].shape = mesh;
     }},
    {"inverted_mesh /bodies/2/shape",
     [](Scene& s) { s.bodies[2].shape = inside_out(ball_mesh()); }},
    {"out_of_range /bodies/2/shape/triangles/3",
     [](Scene& s) {
       MeshShape mesh = ball_mesh();
       mesh.triangles[3][1] = 8;
       s.bodies[2].shape = mesh;
     }},
    {"no_particles /bodies/2/spacing",
     [](Scene& s) {
       // Two boxes. The only lattice point is at their common centre, between them.
       s.bodies[2].spacing = 0.3;
       s.bodies[2].shape = joined(box_mesh({0.4, 0.4, 0.7}, {0.45, 0.6, 0.9}),
                                  box_mesh({0.55, 0.4, 0.7}, {0.6, 0.6, 0.9}));
     }},
    {"out_of_range /bodies/3/shape/positions", [](Scene& s) { particles(s).positions.clear(); }},
    {"out_of_range /bodies/3/shape/positions/1",
     [](Scene& s) { particles(s).positions[1].z() = kNan; }},
    {"wrong_length /bodies/3/shape/masses", [](Scene& s) { particles(s).masses = {1}; }},
    {"out_of_range /bodies/3/shape/masses/0", [](Scene& s) { particles(s).masses[0] = 0; }},
    {"out_of_range /bodies/3/shape/radii/1", [](Scene& s) { particles(s).radii[1] = kInfinity; }},
    {"wrong_length /bodies/3/shape/velocities",
     [](Scene& s) { particles(s).velocities = {Vec3::Zero()}; }},
    {"out_of_range /bodies/3/shape/fixed/0", [](Scene& s) { particles(s).fixed = {2}; }},
    {"duplicate /bodies/3/shape/fixed", [](Scene& s) { particles(s).fixed.assign(2, 1); }},
    {"not_allowed /bodies/3/mass", [](Scene& s) { s.bodies[3].mass = 2; }},
    {"not_allowed /bodies/3/radius", [](Scene& s) { s.bodies[3].radius = 0.01; }},
    {"missing /bodies/3/mass", [](Scene& s) { particles(s).masses.clear(); }},
    {"missing /bodies/3/radius", [](Scene& s) { particles(s).radii.clear(); }},
    {"out_of_range /bodies/3/springs/0/particles", [](Scene& s) { s.bodies[3].springs[0].b = 2; }},
    {"out_of_range /bodies/3/springs/0/particles", [](Scene& s) { s.bodies[3].springs[0].b = 0; }},
    {"out_of_range /bodies/3/springs/0/stiffness",
     [](Scene& s) { s.bodies[3].springs[0].constants.stiffness = -1; }},
    {"out_of_range /bodies/3/springs/0/rest_length",
     [](Scene& s) { s.bodies[3].springs[0].rest_length = -1; }},
    {"out_of_range /materials/0/tearing_strain",
     [](Scene& s) { s.materials[0].tearing_strain = 0; }},
    {"out_of_range /materials/0/plasticity/yield_strain",
     [](Scene& s) { s.materials[0].plasticity.emplace().yield_strain = -1; }},
    {"out_of_range /materials/0/plasticity/hardening",
     [](Scene& s) { s.materials[0].plasticity.emplace().hardening = -1; }},
    {"out_of_range /materials/0/plasticity/relaxation_time",
     [](Scene& s) { s.materials[0].plasticity.emplace().relaxation_time = -1; }},
    {"out_of_range /materials/0/plasticity/max_strain",
     [](Scene& s) { s.materials[0].plasticity.emplace().max_strain = 1; }},
};

TEST(Validate, FindsEveryMistakeAlone) {
  for (const auto& [error, make] : kMistakes) {
    Scene scene = valid_scene();
    make(scene);
    EXPECT_EQ(errors_of(find_errors(scene)), error);
    EXPECT_FALSE(Simulation::create(scene).ok()) << error;
  }
}

TEST(Validate, NamesTheIntegratorAndTheSolverThatItCannotDrive) {
  Scene scene = valid_scene();
  scene.pressure_solver = PressureSolver::incompressible;
  scene.numerics.integrator = IntegratorId::runge_kutta_4;
  const Errors errors = find_errors(scene);
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_EQ(errors[0].path, "/numerics/integrator");
  EXPECT_THAT(errors[0].message, testing::AllOf(testing::HasSubstr("incompressible"),
                                                testing::HasSubstr("runge_kutta_4")));
  scene.numerics.integrator = IntegratorId::symplectic_euler;
  EXPECT_THAT(find_errors(scene), testing::IsEmpty());
  scene.bodies.resize(1);  // springs would need too short steps for a method of order 1
  scene.numerics = {};
  scene.numerics.accuracy = 0.01;
  EXPECT_THAT(find_errors(scene), testing::IsEmpty());
  const Simulation simulation = Simulation::create(scene).value();
  EXPECT_EQ(simulation.scene().numerics.integrator, IntegratorId::symplectic_euler);
  EXPECT_EQ(simulation.scene().numerics.control, StepControl::adaptive);
}

TEST(Validate, ReportsEveryMistakeAtOnce) {
  Scene scene = valid_scene();
  scene.numerics.step = -1;
  scene.materials[0].density = kNan;
  scene.bodies[0].spacing = 0;
  scene.bodies[2].mass = -1;
  EXPECT_EQ(errors_of(find_errors(scene)),
            "out_of_range /materials/0/density\nout_of_range /numerics/step\n"
            "out_of_range /bodies/0/spacing\nout_of_range /bodies/2/mass");
}

TEST(Validate, ChecksABodyToBeAdded) {
  Scene scene = valid_scene();
  BodyDescription body = scene.bodies[2];
  EXPECT_EQ(find_body_errors(scene, body, "/body").at(0).path, "/body/name");
  body.name = "another ball";
  EXPECT_TRUE(find_body_errors(scene, body, "/body").empty());
  body.material = "cheese";
  EXPECT_EQ(errors_of(find_body_errors(scene, body, "/body")), "unknown_name /body/material");
}

TEST(Validate, SamplesOnlyTheBodyToBeAdded) {
  Scene scene = valid_scene();
  const std::vector<Vec3> far = {{0.9, 0.9, 0.9}};
  const std::vector<Real> radius = {0.01};
  CurrentScene present;
  present.bodies.assign(scene.bodies.size(), {far, radius, 0});
  scene.bodies[0].spacing = 1e-5;  // too fine to sample
  BodyDescription body = scene.bodies[2];
  body.name = "another ball";
  EXPECT_EQ(errors_of(find_body_errors(scene, present, body, "/body")), "");
  present.bodies[1].springs = kMaxSprings;
  EXPECT_EQ(errors_of(find_body_errors(scene, present, body, "/body")), "");
  present.bodies[1].springs = kMaxSprings + 1;
  EXPECT_EQ(errors_of(find_body_errors(scene, present, body, "/body")), "too_many /body");
}

TEST(Validate, AddsABodyInTheMovedVat) {
  Scene scene = valid_scene();
  scene.bodies.clear();
  BodyDescription body = valid_scene().bodies[2];  // 0.4 to 0.6 m of 0 to 1 m
  CurrentScene present;
  const auto codes = [&] { return errors_of(find_body_errors(scene, present, body, "/body")); };
  EXPECT_EQ(codes(), "");
  present.vat_offset = {0.5, 0, 0};
  EXPECT_EQ(codes(), "outside_vat /body");
  body.position = {0.8, 0, 0};  // beyond the wall's position at time 0
  EXPECT_EQ(codes(), "");
}

}  // namespace
}  // namespace vat::test::validate_test
