#include <algorithm>
#include <cmath>

#include "tests/stability/adversarial/cases.h"
#include "tests/stability/builders.h"

namespace vat::stability {
namespace {

/// A spring compressed to a fraction `part` of its length exerts at most k l. Its particles start
/// at rest. When it is relaxed, they separate with l (1 - part) sqrt(k / mu), which is their
/// maximum speed.
void add_springs(Cases& cases) {
  for (const Real part : {0.5, 0.1, 0.01}) {
    constexpr Real kLength = 1;
    constexpr Real kStiffness = 100;
    Scene scene = make_scene();
    scene.gravity = Vec3::Zero();
    scene.bodies = {make_spring_pair("pair", part * kLength, kLength, {kStiffness, 0}, {0.5, 0.5})};
    const Real fastest = kLength * (1 - part) * std::sqrt(kStiffness / 0.25);
    cases.push_back(
        {.group = "crushed spring",
         .name = "spring at " + label(part) + " of its length",
         .scene = scene,
         .duration = 1,
         .judge = [fastest](const Simulation& simulation) {
           const Real speed =
               (test::velocity_of(simulation, 0, 1) - test::velocity_of(simulation, 0, 0)).norm();
           return speed <= 1.001 * fastest ? std::string() : "parts at " + label(speed) + " m/s";
         }});
  }
}

void add_lattices(Cases& cases) {
  for (const Real part : {0.5, 0.1, 0.01}) {
    Scene scene = make_scene();
    scene.gravity = Vec3::Zero();
    BodyDescription body = make_block("block", BodyKind::deformable, 4, Vec3::Zero());
    for (SpringDescription& spring : body.springs) {
      const auto& points = std::get<ParticleShape>(body.shape).positions;
      spring.rest_length = (points[spring.a] - points[spring.b]).norm();
    }
    for (Vec3& point : std::get<ParticleShape>(body.shape).positions) point *= part;
    scene.bodies = {body};
    cases.push_back({.group = "crushed lattice",
                     .name = "lattice at " + label(part) + " of its size",
                     .scene = scene,
                     .judge = [](const Simulation& simulation) {
                       const Real momentum = relative_momentum(simulation);
                       return momentum < 1e-12 ? std::string() : "momentum " + label(momentum);
                     }});
  }
}

void add_contacts(Cases& cases) {
  for (const Real part : {0.1, 0.01}) {
    for (const BodyKind kind : {BodyKind::deformable, BodyKind::rigid}) {
      Scene scene = make_tank();
      scene.bodies = {make_particle("a", kind, {0.5, 0.5, 0.025 * part}, 0.1),
                      make_particle("b", kind, {0.5, 0.5, 0.025 * part + part * kSpacing}, 0.1)};
      cases.push_back({.group = std::string("crushed contact of ") + to_string(kind),
                       .name = std::string("contact of ") + to_string(kind) + " at " + label(part) +
                               " of its length, on the floor",
                       .scene = scene});
    }
  }
}

/// Returns the energy per mass [J/kg] that a gas with p = k (rho - rho_0) releases as it expands
/// from `density` times rho_0.
Real internal_energy(Real stiffness, Real density) {
  return stiffness * (std::log(density) + 1 / density - 1);
}

/// Liquid at a multiple of its rest density, in the middle of a tank or filling a narrow one. The
/// walls resist the initial pressure, and eight particles in a row at the speed of expansion.
void add_liquids(Cases& cases) {
  constexpr Real kRadius = kSpacing / 2;
  for (const Real density : {1.5, 3.0, 10.0}) {
    for (const bool confined : {false, true}) {
      const Real spacing = kSpacing / std::cbrt(density);
      Scene scene = make_tank();
      BodyDescription block = make_block("block", BodyKind::liquid, 8, {0.5, 0.5, 0.5}, spacing);
      std::get<ParticleShape>(block.shape).masses.assign(512, 0.125);
      block.radius = kRadius;
      if (confined) {
        scene.vat->min = Vec3::Constant(0.5 - 4 * spacing);
        scene.vat->max = Vec3::Constant(0.5 + 4 * spacing);
      }
      const Real push = 100 * 1000 * (density - 1) * spacing * spacing;
      const Real burst = 8 * 0.125 * 2 * internal_energy(100, density);
      for (auto& interface : scene.interfaces) {
        interface.constants.stiffness =
            std::max({1e4, 8 * push / kRadius, 8 * burst / (kRadius * kRadius)});
      }
      scene.bodies = {block};
      take_stable_step(scene, 0.3);
      cases.push_back({.group = confined ? "crushed liquid in a narrow vat" : "crushed liquid",
                       .name = std::string(confined ? "confined " : "") + "liquid at " +
                               label(density) + " of its density",
                       .scene = scene,
                       .duration = 0.1});
    }
  }
}

/// Walls that are too soft for their load.
void add_soft_walls(Cases& cases) {
  constexpr Real kGravities = 50;
  for (const BodyKind kind : kKinds) {
    for (const IntegratorId integrator : test::kIntegrators) {
      Scene scene = make_tank();
      scene.numerics.integrator = integrator;
      scene.gravity = kGravities * 9.81 * Vec3(0.6, 0, -0.8);
      scene.vat->motion = SlideMotion{{1, 1, 0}, 0.2, 0.5};
      for (auto& interface : scene.interfaces) interface.constants = {1e-3, 0};
      scene.bodies = {make_block("block", kind, 4, {0.5, 0.5, 0.3})};
      cases.push_back({.group = std::string("soft walls under 50 g: ") + to_string(kind),
                       .name = std::string("soft walls under 50 g: ") + to_string(kind) + ", " +
                               vat::to_string(integrator),
                       .scene = scene,
                       .expected = kind == BodyKind::liquid ? Expected::may_stop : Expected::runs});
    }
  }
}

}  // namespace

void add_compression_cases(Cases& cases) {
  add_springs(cases);
  add_lattices(cases);
  add_contacts(cases);
  add_liquids(cases);
  add_soft_walls(cases);
}

}  // namespace vat::stability
