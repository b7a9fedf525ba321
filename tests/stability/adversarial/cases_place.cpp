#include <algorithm>
#include <cmath>

#include "tests/stability/adversarial/cases.h"
#include "tests/stability/builders.h"

namespace vat::stability {
namespace {

/// Bodies of all kinds in contact, in a tank at `offset`.
Scene make_mixed_tank(const Vec3& offset) {
  Scene scene = make_tank();
  scene.vat->min += offset;
  scene.vat->max += offset;
  scene.bodies = {make_block("pool", BodyKind::liquid, 5, offset + Vec3(0.5, 0.5, 0.14)),
                  make_block("jelly", BodyKind::deformable, 3, offset + Vec3(0.45, 0.5, 0.34)),
                  make_block("cube", BodyKind::rigid, 3, offset + Vec3(0.6, 0.5, 0.36))};
  scene.bodies[2].angular_velocity = {1, 2, 3};
  return scene;
}

/// Returns the largest distance between the particles of two runs of one scene. One run is
/// displaced by `offset` [m].
Real greatest_distance(const Simulation& a, const Simulation& b, const Vec3& offset) {
  Real greatest = 0;
  const auto first = a.bodies();
  const auto second = b.bodies();
  for (std::size_t body = 0; body < first.size(); ++body) {
    for (std::size_t i = 0; i < first[body].positions.size(); ++i) {
      const Vec3 apart = first[body].positions[i] - offset - second[body].positions[i];
      greatest = std::max(greatest, apart.norm());
    }
  }
  return greatest;
}

void add_far_places(Cases& cases) {
  for (const Real distance : {1e2, 1e3, 1e4, 1e5}) {
    const Vec3 offset = distance * Vec3(1, -1, 1);
    cases.push_back(
        {.group = "far from the origin",
         .name = label(distance) + " m from the origin",
         .scene = make_mixed_tank(offset),
         .duration = 0.2,
         .judge = [offset](const Simulation& far) {
           Simulation near = test::make_simulation(make_mixed_tank(Vec3::Zero()));
           near.advance(static_cast<std::uint32_t>(std::lround(far.time() / near.step_size())));
           const Real apart = greatest_distance(far, near, offset);
           return apart <= 1e-6 * kSpacing ? std::string()
                                           : label(apart) + " m from the run at the origin";
         }});
  }
}

void add_few(Cases& cases) {
  for (const BodyKind kind : kKinds) {
    for (const bool in_tank : {false, true}) {
      Scene scene = in_tank ? make_tank() : make_scene();
      scene.bodies = {make_particle("one", kind, {0.5, 0.5, 0.5}, 0.125)};
      scene.bodies[0].velocity = {0.1, 0, 0};
      cases.push_back({.group = std::string("one particle: ") + to_string(kind),
                       .name = std::string("one ") + to_string(kind) +
                               (in_tank ? " particle in a tank" : " particle"),
                       .scene = scene,
                       .duration = 1});
    }
  }
  for (const bool in_tank : {false, true}) {
    cases.push_back({.group = "no particle",
                     .name = in_tank ? "an empty tank" : "nothing",
                     .scene = in_tank ? make_tank() : make_scene()});
  }
}

/// Below rest density there is no pressure. One or two particles fly ballistically, except for
/// round-off.
void add_isolated_liquid(Cases& cases) {
  for (const std::size_t count : {1U, 2U}) {
    Scene scene = make_scene();
    scene.bodies = {make_block("drop", BodyKind::liquid, 1, Vec3::Zero())};
    auto& shape = std::get<ParticleShape>(scene.bodies[0].shape);
    if (count == 2) {
      shape.positions.push_back({kSpacing, 0, 0});
      shape.masses.push_back(shape.masses[0]);
    }
    const Vec3 velocity(1, 2, 3);
    scene.bodies[0].velocity = velocity;
    cases.push_back({.group = "isolated liquid",
                     .name = std::to_string(count) + " isolated particles of a liquid",
                     .scene = scene,
                     .duration = 1,
                     .judge = [velocity](const Simulation& simulation) {
                       const Real t = simulation.time();
                       const Vec3 flown = t * velocity - Vec3(0, 0, 0.5 * 9.81 * t * t);
                       // A thousand additions of numbers up to 5, with half a unit of round-off
                       // each.
                       const Real error = (test::position_of(simulation, 0) - flown).norm();
                       return error < 1e-12 ? std::string() : label(error) + " m off";
                     }});
  }
}

/// Rigid bodies whose inertia would be singular without the size of the particles.
void add_thin_rigid_bodies(Cases& cases) {
  const std::pair<const char*, std::vector<Vec3>> shapes[] = {
      {"point", {{0, 0, 0}}},
      {"two points in one place", {{0, 0, 0}, {0, 0, 0}}},
      {"rod", {{0, 0, 0}, {0.05, 0, 0}, {0.1, 0, 0}, {0.15, 0, 0}}},
      {"plate", test::make_lattice(4, 4, 1, kSpacing)},
  };
  for (const auto& [name, points] : shapes) {
    for (const Real spin : {0.0, 100.0}) {
      Scene scene = make_tank();
      // A corner of the plate hits with 0.1 m times the spin, and the plate's mass.
      for (auto& interface : scene.interfaces) interface.constants.stiffness = 1e6;
      scene.bodies = {test::make_body("thin", BodyKind::rigid, "wood",
                                      test::make_particles(points, 0.1), kSpacing / 2)};
      scene.bodies[0].position = {0.5, 0.5, 0.5};
      scene.bodies[0].angular_velocity = {spin, 0.01 * spin, 0};
      take_stable_step(scene, 0.3);
      cases.push_back(
          {.group = std::string("rigid ") + name,
           .name = std::string("rigid ") + name + " turning with " + label(spin) + " rad/s",
           .scene = scene});
    }
  }
}

/// A liquid block of n^3 particles above the floor, and `layers` layers of rigid blocks above it.
Scene make_crowd(int n, int layers) {
  Scene scene = make_tank();
  const Real width = (n + 2) * kSpacing;
  scene.vat->max = {width, width, 4 * width};
  scene.bodies = {
      make_block("pool", BodyKind::liquid, n, Vec3(width / 2, width / 2, width / 2 + kSpacing))};
  const int row = n / 4;
  for (int b = 0; b < layers * row * row; ++b) {
    const int layer = b / (row * row);
    const Vec3 cell(b % row, b / row % row, layer);
    const Vec3 center = (0.11 + kSpacing) * Vec3::Ones() + 4 * kSpacing * cell;
    scene.bodies.push_back(make_block("cube " + std::to_string(b), BodyKind::rigid, 3,
                                      center + Vec3(0, 0, width + 2 * kSpacing)));
  }
  return scene;
}

void add_crowd(Cases& cases) {
  cases.push_back({.group = "crowd",
                   .name = "10 000 particles dropped at once",
                   .scene = make_crowd(20, 3),
                   .duration = 0.2});
}

}  // namespace

void add_place_cases(Cases& cases) {
  add_far_places(cases);
  add_few(cases);
  add_isolated_liquid(cases);
  add_thin_rigid_bodies(cases);
  add_crowd(cases);
}

std::vector<AdversarialCase> large_adversarial_cases() {
  return {{.group = "large crowd",
           .name = "100 000 particles dropped at once",
           .scene = make_crowd(44, 5),
           .duration = 0.2}};
}

}  // namespace vat::stability
