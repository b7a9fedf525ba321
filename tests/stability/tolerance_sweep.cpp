#include "tests/stability/tolerance_sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "core/simulation/simulation.h"
#include "tests/support/scenes.h"

namespace vat::stability {
namespace {

constexpr Real kSweepSpacing = 1.0 / 12;  // [m]

Scene make_pool(const Vec3& size, const Vec3& min, const Vec3& max) {
  Scene scene = test::make_scene(IntegratorId::symplectic_euler, 0.02);
  scene.gravity = {0, 0, -9.81};
  scene.numerics.tick = 0.02;
  scene.numerics.control = StepControl::adaptive;
  scene.pressure_solver = PressureSolver::incompressible;
  scene.materials = {test::make_liquid("water", 1000, {350, 10, 2 * kSweepSpacing}),
                     test::make_material("wood", 500)};
  scene.vat = Vat{min, max, true, {}, {}};
  BodyDescription pool;
  pool.name = "pool";
  pool.kind = BodyKind::liquid;
  pool.material = "water";
  pool.spacing = kSweepSpacing;
  pool.shape = BoxShape{min + size / 2, size};
  scene.bodies = {pool};
  return scene;
}

/// A two-dimensional dam break of water beside a fixed body.
Scene make_flat_dam_break() {
  constexpr Real kSpacing = 0.02;  // [m]
  Scene scene = make_pool({1, 0.12, 0.5}, {0, -0.06, 0}, {9, 0.06, 0.9});
  scene.dimensions = 2;
  scene.materials[0].liquid->support_radius = 3 * kSpacing;
  scene.materials[0].liquid->viscosity = 0;
  scene.bodies[0].spacing = kSpacing;
  BodyDescription wall;
  wall.name = "wall";
  wall.kind = BodyKind::rigid;
  wall.material = "wood";
  wall.spacing = kSpacing;
  wall.fixed = true;
  wall.shape = BoxShape{Vec3::Zero(), {0.06, 0.12, 0.84}};
  wall.position = {-0.03, 0, 0.42};
  scene.vat->min.x() = -0.1;
  scene.bodies.push_back(wall);
  return scene;
}

Scene make_named(const std::string& name) {
  if (name == "dam-break") return make_pool({1, 1, 1}, {-2, -0.75, 0}, {2, 0.75, 3});
  if (name == "deep-tank") return make_pool({0.5, 0.5, 2}, {0, 0, 0}, {0.5, 0.5, 2.5});
  if (name == "flat-dam-break") return make_flat_dam_break();
  Scene scene = make_pool({1, 1, 0.5}, {0, 0, 0}, {1, 1, 1});
  if (name == "sloshing-tank") {
    scene.vat->motion = SlideMotion{{1, 0, 0}, 0.2, 1};
    return scene;
  }
  BodyDescription ball;
  ball.name = "ball";
  ball.kind = BodyKind::rigid;
  ball.material = "wood";
  ball.spacing = kSweepSpacing / 2;
  ball.shape = SphereShape{Vec3::Zero(), 0.15};
  ball.position = {0.5, 0.5, 0.75};
  scene.bodies.push_back(ball);
  return scene;
}

Real total_energy(const Diagnostics& now) {
  return now.kinetic_energy + now.gravitational_energy + now.elastic_energy + now.contact_energy;
}

}  // namespace

Real TolerancePoint::products() const {
  return static_cast<Real>(steps) * (2 + velocity_iterations + position_iterations);
}

Scene tolerance_scene(const std::string& name, Real tolerance) {
  Scene scene = make_named(name);
  scene.incompressible.density_tolerance = tolerance;
  scene.incompressible.divergence_tolerance = tolerance;
  return scene;
}

TolerancePoint measure_tolerance(const std::string& name, Real tolerance, Real seconds) {
  using Clock = std::chrono::steady_clock;
  Simulation simulation = test::make_simulation(tolerance_scene(name, tolerance));
  const auto ticks = static_cast<int>(std::lround(seconds / 0.02));
  TolerancePoint point{.scene = name, .tolerance = tolerance};
  const Diagnostics first = simulation.diagnostics();
  std::uint64_t velocities = 0;
  std::uint64_t places = 0;
  for (int n = 0; n < ticks; ++n) {
    const Clock::time_point start = Clock::now();
    const AdvanceReport report = simulation.advance(simulation.steps_per_tick());
    point.seconds += std::chrono::duration<double>(Clock::now() - start).count();
    point.steps += report.steps;
    point.failed |= report.failed;
    if (point.failed) return point;
    velocities += report.iterations.velocities;
    places += report.iterations.places;
    const Diagnostics now = simulation.diagnostics();
    point.density_error = std::max(point.density_error, now.mean_density_error);
    point.energy_gain = std::max(point.energy_gain, total_energy(now) - total_energy(first));
    point.released =
        std::max(point.released, first.gravitational_energy - now.gravitational_energy);
  }
  point.velocity_iterations = static_cast<Real>(velocities) / static_cast<Real>(point.steps);
  point.position_iterations = static_cast<Real>(places) / static_cast<Real>(point.steps);
  return point;
}

std::vector<Real> all_tolerances() {
  return {1e-5, 3e-5, 1e-4, 3e-4, 5e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1};
}

}  // namespace vat::stability
