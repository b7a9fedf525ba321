#include "tests/stability/maps/projection_map.h"

#include <algorithm>
#include <string>

#include "core/simulation/simulation.h"
#include "tests/support/scenes.h"

namespace vat::stability {
namespace {

constexpr int kBalls = 5;
constexpr Real kMapRadius = 0.5;    // [m]
constexpr Real kDrop = 0.01;        // [m]
constexpr Real kMapGravity = 9.81;  // [m/s^2]

Scene make_map_stack(const ProjectionPoint& point) {
  Scene scene = test::make_scene(point.integrator, point.step);
  scene.gravity = {0, 0, -kMapGravity};
  scene.materials = {test::make_material("steel")};
  scene.default_interface = {.friction = 0.5, .law = InterfaceLaw::projection};
  scene.vat = Vat{{-5, -5, 0}, {5, 5, 10}, false, {}, {}};
  for (int i = 0; i < kBalls; ++i) {
    const Real mass = i % 2 == 0 ? 1 : point.mass_ratio;
    BodyDescription ball = test::make_body("ball " + std::to_string(i), BodyKind::rigid, "steel",
                                           test::make_particles({{0, 0, 0}}, mass), kMapRadius);
    ball.position.z() = kMapRadius * (2 * i + 1) + kDrop * (i + 1);
    scene.bodies.push_back(ball);
  }
  return scene;
}

Real mechanical(const Diagnostics& now) {
  return now.kinetic_energy + now.gravitational_energy;
}

Real greatest_overlap(const Simulation& simulation) {
  Real greatest = 0;
  Real below = -kMapRadius;
  for (const BodyView& body : simulation.bodies()) {
    const Real z = body.positions[0].z();
    greatest = std::max(greatest, 2 * kMapRadius - (z - below));
    below = z;
  }
  return greatest / (2 * kMapRadius);
}

}  // namespace

std::vector<ProjectionPoint> projection_points(bool quick) {
  std::vector<ProjectionPoint> points;
  for (const IntegratorId integrator :
       {IntegratorId::velocity_verlet, IntegratorId::symplectic_euler}) {
    for (const Real ratio : {1.0, 10.0, 100.0, 1000.0}) {
      for (const Real step : {1e-4, 1e-3, 1e-2, 1.0 / 60, 0.05, 0.1}) {
        if (quick && (step < 1e-2 || ratio == 10)) continue;
        points.push_back({.integrator = integrator, .mass_ratio = ratio, .step = step});
      }
    }
  }
  return points;
}

ProjectionPoint measure_projection(ProjectionPoint point) {
  constexpr int kSteps = 1000;
  Simulation simulation = test::make_simulation(make_map_stack(point));
  const Real start = mechanical(simulation.diagnostics());
  Real fall = 0;
  for (const BodyView& body : simulation.bodies()) fall += body.masses[0] * kMapGravity * kDrop;
  for (int n = 0; n < kSteps; ++n) {
    point.is_guarded |= simulation.advance(1).undone_steps > 0;
    const Diagnostics now = simulation.diagnostics();
    point.energy_gain = std::max(point.energy_gain, (mechanical(now) - start) / fall);
    point.kinetic_energy = now.kinetic_energy / fall;
    if (2 * n >= kSteps) point.overlap = std::max(point.overlap, greatest_overlap(simulation));
  }
  return point;
}

bool is_stable(const ProjectionPoint& point) {
  constexpr Real kSeen = 1e-3;  // relative to the diameter
  constexpr Real kRoundOff = 1e-9;
  // Runs with the shortest steps end before the fall does.
  const bool has_landed = point.step >= 1e-3;
  return !point.is_guarded && point.energy_gain <= kRoundOff && point.overlap <= kSeen &&
         (!has_landed || point.kinetic_energy <= kSeen);
}

}  // namespace vat::stability
