#include <algorithm>
#include <cmath>

#include "tests/stability/adversarial/cases.h"
#include "tests/stability/builders.h"
#include "tests/support/totals.h"

namespace vat::stability {

Real relative_momentum(const Simulation& simulation) {
  const Real motion = test::motion_of(simulation).momentum;
  const Vec3 momentum = test::totals_of(simulation.diagnostics()).momentum;
  return motion > 0 ? momentum.norm() / motion : 0;
}

namespace {

constexpr int kEdge = 3;  // particles along the edge of a block

std::string names(BodyKind first, BodyKind second) {
  return std::string(to_string(first)) + " and " + to_string(second);
}

/// Two blocks in free space. The second is displaced from the first. Liquids have different
/// materials.
Scene make_two_blocks(BodyKind first, BodyKind second, const Vec3& shift) {
  Scene scene = make_scene();
  scene.gravity = Vec3::Zero();
  scene.bodies = {make_block("first", first, kEdge, Vec3::Zero()),
                  make_block("second", second, kEdge, shift)};
  if (second == BodyKind::liquid) scene.bodies[1].material = "oil";
  return scene;
}

std::string judge_momentum(const Simulation& simulation) {
  const Real momentum = relative_momentum(simulation);
  return momentum < 1e-12 ? "" : "momentum " + label(momentum);
}

void add_blocks(Cases& cases) {
  const Real edge = kEdge * kSpacing;
  for (std::size_t a = 0; a < std::size(kKinds); ++a) {
    for (std::size_t b = a; b < std::size(kKinds); ++b) {
      const std::string kinds = names(kKinds[b], kKinds[a]);
      for (const Real depth : {0.1, 0.5, 0.99}) {
        cases.push_back(
            {.group = "overlap of " + kinds,
             .name = "overlap of " + kinds + " by " + label(depth),
             .scene = make_two_blocks(kKinds[b], kKinds[a], {edge * (1 - depth), 0.003, 0.001}),
             .judge = judge_momentum});
      }
      cases.push_back({.group = "coincident " + kinds,
                       .name = "coincident " + kinds,
                       .scene = make_two_blocks(kKinds[b], kKinds[a], Vec3::Zero()),
                       .judge = judge_momentum});
    }
  }
}

/// Two particles of any kinds that overlap by delta, with springs of stiffness k, separate with
/// delta sqrt(k / mu).
void add_pairs(Cases& cases) {
  for (const Real depth : {0.01, 0.5, 0.9}) {
    constexpr Real kStiffness = 1000;
    Scene scene = make_scene();
    scene.gravity = Vec3::Zero();
    scene.default_interface = {kStiffness, 0};
    scene.numerics.step = 1e-4;
    const Real distance = kSpacing * (1 - depth);
    scene.bodies = {make_particle("a", BodyKind::rigid, {0, 0, 0}, 0.1),
                    make_particle("b", BodyKind::deformable, {distance, 0, 0}, 0.3)};
    const Real reduced_mass = 0.1 * 0.3 / 0.4;
    const Real speed = depth * kSpacing * std::sqrt(kStiffness / reduced_mass);
    cases.push_back({.group = "overlapping pair",
                     .name = "overlapping pair, depth " + label(depth),
                     .scene = scene,
                     .duration = 0.1,
                     .judge = [speed](const Simulation& simulation) {
                       const Vec3 apart =
                           test::velocity_of(simulation, 1) - test::velocity_of(simulation, 0);
                       // The error of Verlet over half an oscillation is z^2/24, and the same again
                       // for the step in which the contact ends; z = 0.0115.
                       const bool good = std::abs(apart.x() / speed - 1) < 1e-4;
                       return good ? std::string() : "parts at " + label(apart.x()) + " m/s";
                     }});
  }
}

/// Particles of one body that coincide or nearly coincide.
void add_within_a_body(Cases& cases) {
  for (const Real distance : {0.0, 1e-300, 1e-160, 1e-12}) {
    for (const BodyKind kind : kKinds) {
      Scene scene = make_scene();
      scene.gravity = Vec3::Zero();
      BodyDescription body =
          test::make_body("body", kind, material_of(kind),
                          test::make_particles({{0, 0, 0}, {distance, 0, 0}}, 0.125), 0.025);
      if (kind == BodyKind::deformable) body.springs = {{0, 1, {100, 0.1}, kSpacing}};
      scene.bodies = {body};
      cases.push_back({.group = std::string("coincident particles of one ") + to_string(kind),
                       .name = std::string("particles of one ") + to_string(kind) + ", " +
                               label(distance) + " m apart",
                       .scene = scene,
                       .judge = judge_momentum});
    }
  }
  Scene scene = make_scene();
  scene.bodies = {make_spring_pair("none", 0, 0, {100, 1}, {1, 1})};
  cases.push_back({.group = "spring without length", .name = "spring of length 0", .scene = scene});
}

BodyDescription make_heap(BodyKind kind, std::size_t count) {
  return test::make_body("heap", kind, material_of(kind),
                         test::make_particles(std::vector<Vec3>(count, Vec3(0.5, 0.5, 0.5)), 0.125),
                         0.025);
}

/// Coincident particles. A liquid of n particles has n^2 pairs. Above the limit it is refused, and
/// at the limit it must fit into memory.
void add_heaps(Cases& cases) {
  for (const BodyKind kind : kKinds) {
    for (const std::size_t count : {300U, 2000U}) {
      Scene scene = make_tank();
      scene.bodies = {make_heap(kind, count)};
      cases.push_back(
          {.group = std::string("heap of ") + to_string(kind),
           .name = std::to_string(count) + " particles of one " + to_string(kind) + " in one place",
           .scene = scene,
           .expected = kind == BodyKind::liquid ? Expected::may_stop : Expected::runs,
           .duration = 0.1});
    }
  }
  Scene refused = make_tank();
  refused.bodies = {make_heap(BodyKind::liquid, 6000)};
  cases.push_back({.group = "heap with too many pairs",
                   .name = "6000 particles of a liquid in one place",
                   .scene = refused,
                   .expected = Expected::refusal});
  Scene bodies = make_tank();
  for (int n = 0; n < 100; ++n) {
    bodies.bodies.push_back(
        make_particle("body " + std::to_string(n), BodyKind::rigid, {0.5, 0.5, 0.5}, 0.1));
  }
  cases.push_back({.group = "heap of rigid bodies",
                   .name = "100 rigid bodies in one place",
                   .scene = bodies,
                   .expected = Expected::may_stop});
}

}  // namespace

void add_overlap_cases(Cases& cases) {
  add_blocks(cases);
  add_pairs(cases);
  add_within_a_body(cases);
  add_heaps(cases);
}

}  // namespace vat::stability
