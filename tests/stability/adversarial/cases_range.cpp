#include <algorithm>
#include <cmath>
#include <limits>

#include "core/limits.h"
#include "tests/stability/adversarial/cases.h"
#include "tests/stability/builders.h"

namespace vat::stability {
namespace {

/// A pool, a jelly and a cube close together. A case changes one value.
Scene make_trio() {
  Scene scene = make_tank();
  scene.bodies = {make_block("pool", BodyKind::liquid, 4, {0.5, 0.5, 0.12}),
                  make_block("jelly", BodyKind::deformable, 3, {0.4, 0.5, 0.3}),
                  make_block("cube", BodyKind::rigid, 3, {0.6, 0.5, 0.3})};
  return scene;
}

using Change = void (*)(Scene&);

void set_contacts(Scene& scene, Real stiffness, Real damping) {
  scene.default_interface = {stiffness, damping};
}

void set_walls(Scene& scene, Real stiffness) {
  for (auto& interface : scene.interfaces) interface.constants = {stiffness, 0};
}

void set_springs(Scene& scene, Real stiffness, Real damping) {
  for (auto& spring : scene.bodies[1].springs) spring.constants = {stiffness, damping};
}

void set_masses(Scene& scene, Real mass) {
  for (BodyDescription& body : scene.bodies) {
    auto& masses = std::get<ParticleShape>(body.shape).masses;
    masses.assign(masses.size(), mass);
  }
}

/// Disabled forces mean free flight: k = 0 is valid.
const std::pair<const char*, Change> kMild[] = {
    {"no stiffness of contacts", [](Scene& s) { set_contacts(s, 0, 0); }},
    {"contacts that only damp", [](Scene& s) { set_contacts(s, 0, 1); }},
    {"no stiffness of springs", [](Scene& s) { set_springs(s, 0, 0); }},
    {"springs that only damp", [](Scene& s) { set_springs(s, 0, 1); }},
    {"no stiffness of the liquid", [](Scene& s) { s.materials[0].liquid->stiffness = 0; }},
    {"no viscosity", [](Scene& s) { s.materials[0].liquid->viscosity = 0; }},
    {"least density", [](Scene& s) { s.materials[1].density = kMinDensity; }},
    {"no gravity", [](Scene& s) { s.gravity = Vec3::Zero(); }},
    {"least step", [](Scene& s) { s.numerics.step = s.numerics.tick = kMinStep; }},
    {"walls without stiffness", [](Scene& s) { set_walls(s, 0); }},
    {"greatest threshold",
     [](Scene& s) {
       s.interfaces.push_back({{"water", "wood"}, {0.1, 0}, 8 * kSpacing});
     }},
    {"least support radius", [](Scene& s) { s.materials[0].liquid->support_radius = kMinLength; }},
    {"greatest support radius",
     [](Scene& s) { s.materials[0].liquid->support_radius = 8 * kSpacing; }},
};

const std::pair<const char*, Change> kHarsh[] = {
    {"greatest stiffness of contacts", [](Scene& s) { set_contacts(s, kMaxStiffness, 0); }},
    {"greatest damping of contacts", [](Scene& s) { set_contacts(s, 1000, kMaxDamping); }},
    {"greatest stiffness of springs", [](Scene& s) { set_springs(s, kMaxStiffness, 0); }},
    {"greatest damping of springs", [](Scene& s) { set_springs(s, 1000, kMaxDamping); }},
    {"greatest stiffness of the liquid",
     [](Scene& s) { s.materials[0].liquid->stiffness = kMaxStiffness; }},
    {"greatest viscosity", [](Scene& s) { s.materials[0].liquid->viscosity = kMaxViscosity; }},
    {"least masses", [](Scene& s) { set_masses(s, kMinMass); }},
    {"greatest masses", [](Scene& s) { set_masses(s, kMaxMass / 100); }},
    {"liquid of the greatest density", [](Scene& s) { s.materials[0].density = kMaxDensity; }},
    {"liquid of the least density", [](Scene& s) { s.materials[0].density = kMinDensity; }},
    {"greatest gravity", [](Scene& s) { s.gravity = Vec3(kMaxGravity, 0, -kMaxGravity); }},
    {"greatest step", [](Scene& s) { s.numerics.step = s.numerics.tick = kMaxStep; }},
    {"greatest speed", [](Scene& s) { s.bodies[2].velocity.x() = kMaxSpeed; }},
    {"greatest spin",
     [](Scene& s) { s.bodies[2].angular_velocity = Vec3(kMaxAngularSpeed, 0, 1); }},
    {"greatest stiffness of walls", [](Scene& s) { set_walls(s, kMaxStiffness); }},
};

}  // namespace

void add_range_cases(Cases& cases) {
  const auto add = [&](const char* name, Change change, Expected expected) {
    AdversarialCase adversarial{
        .group = name, .name = name, .scene = make_trio(), .expected = expected};
    change(adversarial.scene);
    adversarial.duration = std::min(0.3, 2000 * adversarial.scene.numerics.step);
    cases.push_back(adversarial);
  };
  for (const auto& [name, change] : kMild) add(name, change, Expected::runs);
  for (const auto& [name, change] : kHarsh) add(name, change, Expected::may_stop);
}

void add_refusal_cases(Cases& cases) {
  constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();
  constexpr Real kInf = std::numeric_limits<Real>::infinity();
  static const std::pair<const char*, Change> kMistakes[] = {
      {"radius 0", [](Scene& s) { s.bodies[2].radius = 0; }},
      {"negative radius", [](Scene& s) { s.bodies[2].radius = -1; }},
      {"mass 0", [](Scene& s) { set_masses(s, 0); }},
      {"mass that is not a number", [](Scene& s) { set_masses(s, kNan); }},
      {"size 0",
       [](Scene& s) {
         s.bodies[0].shape = BoxShape{Vec3::Zero(), Vec3::Zero()};
       }},
      {"spacing 0",
       [](Scene& s) {
         s.bodies[0].shape = BoxShape{Vec3::Zero(), Vec3::Ones()};
         s.bodies[0].spacing = 0;
       }},
      {"a body without particles",
       [](Scene& s) { std::get<ParticleShape>(s.bodies[0].shape).positions.clear(); }},
      {"negative stiffness", [](Scene& s) { s.default_interface.stiffness = -1; }},
      {"stiffness that is not a number", [](Scene& s) { set_springs(s, kNan, 0); }},
      {"infinite place", [](Scene& s) { s.bodies[0].position.x() = kInf; }},
      {"a place of 1e30 m", [](Scene& s) { s.bodies[0].position.x() = 1e30; }},
      {"velocity that is not a number", [](Scene& s) { s.bodies[1].velocity.y() = kNan; }},
      {"no orientation", [](Scene& s) { s.bodies[2].orientation.coeffs().setZero(); }},
      {"step 0", [](Scene& s) { s.numerics.step = 0; }},
      {"step that is not a number", [](Scene& s) { s.numerics.step = kNan; }},
      {"tick of 1e9 s", [](Scene& s) { s.numerics.tick = 1e9; }},
      {"infinite gravity", [](Scene& s) { s.gravity.z() = kInf; }},
      {"density 0", [](Scene& s) { s.materials[0].density = 0; }},
      {"unknown material", [](Scene& s) { s.bodies[0].material = "ether"; }},
      {"spring from a particle to itself", [](Scene& s) { s.bodies[1].springs[0].b = 0; }},
      {"a vat without inside", [](Scene& s) { s.vat->max.x() = s.vat->min.x(); }},
      {"a body outside the vat", [](Scene& s) { s.bodies[2].position.z() = -1; }},
  };
  for (const auto& [name, mistake] : kMistakes) {
    AdversarialCase adversarial{.group = std::string("refused: ") + name,
                                .name = std::string("refused: ") + name,
                                .scene = make_trio(),
                                .expected = Expected::refusal};
    mistake(adversarial.scene);
    cases.push_back(adversarial);
  }
}

}  // namespace vat::stability
