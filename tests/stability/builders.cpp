#include "tests/stability/builders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/limits.h"
#include "core/numerics/step_limits.h"
#include "core/validation/validate.h"

namespace vat::stability {

Scene make_scene() {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.name = "adversarial";
  scene.materials = {test::make_liquid("water", 1000, {100, 1, 2 * kSpacing}),
                     test::make_liquid("oil", 800, {100, 2, 2 * kSpacing}),
                     test::make_material("rubber", 1000), test::make_material("wood", 600)};
  scene.materials[2].springs =
      LatticeSprings{SpringConstants{2000, 2}, SpringConstants{1000, 1}, {}};
  scene.materials[2].self_contact = SpringConstants{1000, 1};
  scene.default_interface = {1000, 1};
  for (const Material& material : scene.materials) {
    scene.interfaces.push_back({{material.name, kVatMaterial}, {10000, 10}, {}});
  }
  return scene;
}

Scene make_tank() {
  Scene scene = make_scene();
  scene.vat = Vat{Vec3::Zero(), Vec3::Ones(), true, {}, {}};
  return scene;
}

const char* material_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::liquid:
      return "water";
    case BodyKind::deformable:
      return "rubber";
    case BodyKind::rigid:
      return "wood";
  }
  return "";
}

BodyDescription make_block(std::string name, BodyKind kind, int n, const Vec3& center,
                           Real spacing) {
  std::vector<Vec3> points = test::make_lattice(n, n, n, spacing);
  const Real mass = 1000 * spacing * spacing * spacing;
  BodyDescription body = test::make_body(std::move(name), kind, material_of(kind),
                                         test::make_particles(points, mass), spacing / 2);
  body.spacing = spacing;
  body.position = center;
  if (kind == BodyKind::deformable) {
    body.springs = test::join_near(points, 1.5 * spacing, {2000, 2});
  }
  return body;
}

BodyDescription make_particle(std::string name, BodyKind kind, const Vec3& position, Real mass,
                              Real radius) {
  return test::make_body(std::move(name), kind, material_of(kind),
                         test::make_particles({position}, mass), radius);
}

BodyDescription make_spring_pair(std::string name, Real distance, Real rest_length,
                                 const SpringConstants& spring, std::vector<Real> masses) {
  ParticleShape shape = test::make_particles({{0, 0, 0}, {distance, 0, 0}}, 1);
  shape.masses = std::move(masses);
  BodyDescription body = test::make_body(std::move(name), BodyKind::deformable, "rubber",
                                         std::move(shape), kSpacing / 2);
  body.springs = {{0, 1, spring, rest_length}};
  return body;
}

Real least_step_limit(const Scene& scene) {
  std::vector<SampledBody> samples;
  for (const BodyDescription& body : scene.bodies) {
    const auto material = std::ranges::find(scene.materials, body.material, &Material::name);
    samples.push_back(sample_body(body, *material));
  }
  Real least = std::numeric_limits<Real>::infinity();
  for (const StepLimit& limit : find_step_limits(scene, samples)) {
    least = std::min(least, limit.step);
  }
  return least;
}

std::optional<Scene> with_sub_steps(Scene scene) {
  scene.numerics.control = StepControl::local;
  bool has_solid = false;
  for (BodyDescription& body : scene.bodies) {
    if (body.kind == BodyKind::liquid) continue;
    body.sub_steps = 8;
    has_solid = true;
  }
  if (!has_solid || !find_errors(scene).empty()) return {};
  return scene;
}

void take_stable_step(Scene& scene, Real part) {
  constexpr Real kTick = 0.02;
  const Real step = std::clamp(part * least_step_limit(scene), kMinStep, kTick / 4);
  const Real steps = std::min<Real>(std::ceil(kTick / step), kMaxStepsPerTick);
  scene.numerics.step = step;
  scene.numerics.tick = steps * step;
}

}  // namespace vat::stability
