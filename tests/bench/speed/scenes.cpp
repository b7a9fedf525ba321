#include "tests/bench/speed/scenes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/numerics/step_limits.h"
#include "core/sampling/sampling.h"

namespace vat::bench {

namespace {

constexpr Real kTick = 0.02;          // [s]
constexpr Real kLongestStep = 0.005;  // [s] if only speeds limit steps

BodyDescription box_of(std::string name, BodyKind kind, std::string material, Real spacing,
                       const Vec3& center, const Vec3& size) {
  BodyDescription body;
  body.name = std::move(name);
  body.kind = kind;
  body.material = std::move(material);
  body.spacing = spacing;
  body.shape = BoxShape{Vec3::Zero(), size};
  body.position = center;
  return body;
}

Material water(const LiquidConstants& constants) {
  Material material;
  material.name = "water";
  material.liquid = constants;
  return material;
}

/// Returns the longest step [s] for which velocity Verlet treats the viscosity of liquids
/// explicitly: see must_solve_damping(). Sound would permit a slightly longer step, but an implicit
/// solve costs half a step.
Real longest_explicit_step(const Scene& scene) {
  const std::vector<SampledBody> samples = sample_bodies(scene);
  Real step = kTick;
  for (const OscillatingPart& part : find_oscillating_parts(scene, pointers_to(samples))) {
    const auto [omega2, rate] = part.bound;
    step = std::min(step, 2 * (std::sqrt(rate * rate + omega2) - rate) / omega2);
  }
  return step;
}

/// Sets the integrator and step of a liquid scene.
void choose_steps(Scene& scene) {
  scene.numerics.tick = kTick;
  if (scene.pressure_solver == PressureSolver::incompressible) {
    scene.numerics.integrator = IntegratorId::symplectic_euler;
    scene.numerics.control = StepControl::adaptive;
    scene.numerics.step = kTick;
    return;
  }
  scene.numerics.step = kTick / std::ceil(kTick / longest_explicit_step(scene));
}

Vat closed_vat(const Vec3& min, const Vec3& max) {
  Vat vat;
  vat.min = min;
  vat.max = max;
  vat.lid = true;
  return vat;
}

/// Returns a pseudo-random rotation that depends on `n` only. Upright bodies would remain upright.
Quat turn_of(std::uint32_t n) {
  const auto part = [n](std::uint32_t factor) {
    return static_cast<Real>(n * factor % 1009) / 1009 - 0.5;
  };
  return Quat(0.6, part(367), part(521), part(613)).normalized();
}

/// A pile of bodies in a vat, 0.2 m apart, about as high as wide.
class PileShape {
 public:
  explicit PileShape(std::uint32_t bodies)
      : width_(std::max(5U, static_cast<std::uint32_t>(std::lround(0.8 * std::cbrt(bodies))))),
        layers_((bodies - 1) / (width_ * width_) + 1) {}

  /// Returns the place of body n. The lowest layer is at `height` [m].
  Vec3 place_of(std::uint32_t n, Real height) const {
    const std::uint32_t row = n / width_;
    const std::uint32_t layer = row / width_;
    return Vec3(0.2, 0.2, height) + 0.2 * Vec3(n % width_, row % width_, layer);
  }
  /// Returns a vat that is `height` [m] high for up to 200 bodies.
  Vat vat(Real height) const {
    const Real width = 0.2 * (width_ + 1);
    return closed_vat({0, 0, 0}, {width, width, std::max(height, 0.2 * (layers_ + 2))});
  }

 private:
  std::uint32_t width_;  ///< bodies per row
  std::uint32_t layers_;
};

}  // namespace

Scene dam_break(int layers, PressureSolver solver) {
  const Real spacing = 0.4 / layers;
  const LiquidConstants liquid{.stiffness = 400,
                               .viscosity = 0.1,
                               .support_radius = 2 * spacing,
                               .artificial_viscosity = 0.1};
  Scene scene;
  scene.pressure_solver = solver;
  scene.materials = {water(liquid)};
  scene.vat = closed_vat({0, 0, 0}, {1.6, 0.4, 1.0});
  scene.bodies = {
      box_of("column", BodyKind::liquid, "water", spacing, {0.2, 0.2, 0.4}, {0.4, 0.4, 0.8})};
  choose_steps(scene);
  return scene;
}

Scene peer_dam_break(int edge, PressureSolver solver) {
  const Real spacing = 1.0 / edge;
  const LiquidConstants liquid{.stiffness = 350, .viscosity = 10, .support_radius = 2 * spacing};
  Scene scene;
  scene.pressure_solver = solver;
  scene.materials = {water(liquid)};
  // The tolerance of density changes equals the peer's. The density tolerance leaves a smaller
  // error than the peer's.
  scene.incompressible = {.density_tolerance = 1.5e-3, .divergence_tolerance = 1e-3};
  scene.vat = closed_vat({-2, -0.75, 0}, {2, 0.75, 3});
  scene.bodies = {box_of("block", BodyKind::liquid, "water", spacing, {-1.5, 0, 0.5}, {1, 1, 1})};
  choose_steps(scene);
  return scene;
}

Scene pool(PressureSolver solver) {
  constexpr Real kSpacing = 0.04;
  const LiquidConstants liquid{.stiffness = 400,
                               .viscosity = 1,
                               .support_radius = 2 * kSpacing,
                               .artificial_viscosity = 0.1};
  Scene scene;
  scene.pressure_solver = solver;
  scene.materials = {water(liquid)};
  scene.vat = closed_vat({0, 0, 0}, {1, 1, 1});
  scene.settling = Settling{.drag = 30, .until = 0.5};
  scene.bodies = {
      box_of("pool", BodyKind::liquid, "water", kSpacing, {0.5, 0.5, 0.32}, {1, 1, 0.64})};
  choose_steps(scene);
  return scene;
}

Scene rigid_pile(std::uint32_t bodies, InterfaceLaw law, Real spacing) {
  Scene scene;
  scene.materials.emplace_back().name = "wood";
  scene.materials.back().density = 600;
  if (law == InterfaceLaw::projection) {
    scene.default_interface = {.friction = 0.4, .law = law};
    scene.numerics.step = kLongestStep;
  } else {
    // Smaller particles need stiffer contacts, so that none passes through a wall.
    const Real stiffness = 8000 * std::pow(0.04 / spacing, 3);
    scene.default_interface = {.stiffness = stiffness, .damping = 20, .friction = 0.4};
  }
  const PileShape pile(bodies);
  scene.vat = pile.vat(3);
  scene.numerics.tick = kTick;
  for (std::uint32_t n = 0; n < bodies; ++n) {
    const Vec3 center = pile.place_of(n, 0.15);
    BodyDescription body = box_of("body " + std::to_string(n + 1), BodyKind::rigid, "wood", spacing,
                                  center, {0.12, 0.12, 0.12});
    if (n % 2 == 1) body.shape = SphereShape{Vec3::Zero(), 0.07};
    body.orientation = turn_of(n);
    scene.bodies.push_back(std::move(body));
  }
  return scene;
}

Scene deformable_pile(std::uint32_t bodies, Real spacing) {
  Scene scene;
  Material& jelly = scene.materials.emplace_back();
  jelly.name = "jelly";
  jelly.density = 500;
  jelly.springs =
      LatticeSprings{SpringConstants{1500, 2}, SpringConstants{750, 1}, SpringConstants{300, 0.5}};
  jelly.self_contact = SpringConstants{2000, 2};
  scene.default_interface = {.stiffness = 5000, .damping = 5, .friction = 0.2};
  const PileShape pile(bodies);
  scene.vat = pile.vat(2);
  scene.numerics.tick = kTick;
  for (std::uint32_t n = 0; n < bodies; ++n) {
    const Vec3 center = pile.place_of(n, 0.2);
    BodyDescription body = box_of("block " + std::to_string(n + 1), BodyKind::deformable, "jelly",
                                  spacing, center, {0.16, 0.16, 0.16});
    body.orientation = turn_of(n);
    scene.bodies.push_back(std::move(body));
  }
  return scene;
}

}  // namespace vat::bench
