#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/simulation/simulation.h"
#include "tests/support/distance.h"

/// Small scenes as values. Bodies consist of explicit particles, so that tests of the core do not
/// depend on the sampler.
namespace vat::test {

inline constexpr std::array kIntegrators = {
    IntegratorId::explicit_euler, IntegratorId::symplectic_euler, IntegratorId::velocity_verlet,
    IntegratorId::heun, IntegratorId::runge_kutta_4};
inline constexpr std::array kBodyKinds = {BodyKind::liquid, BodyKind::deformable, BodyKind::rigid};

/// A scene without bodies, gravity and vat. A tick has one step.
inline Scene make_scene(IntegratorId integrator, Real step, std::vector<Material> materials = {}) {
  Scene scene;
  scene.name = "test";
  scene.pressure_solver = PressureSolver::gas;
  scene.gravity = Vec3::Zero();
  scene.numerics = {integrator, step, step};
  scene.materials = std::move(materials);
  return scene;
}

inline Material make_material(std::string name, Real density = 1000) {
  Material material;
  material.name = std::move(name);
  material.density = density;
  return material;
}

inline Material make_liquid(std::string name, Real density, const LiquidConstants& constants) {
  Material material = make_material(std::move(name), density);
  material.liquid = constants;
  return material;
}

/// Particles of equal mass and radius at rest.
inline ParticleShape make_particles(std::vector<Vec3> positions, Real mass) {
  ParticleShape shape;
  shape.masses.assign(positions.size(), mass);
  shape.positions = std::move(positions);
  return shape;
}

inline BodyDescription make_body(std::string name, BodyKind kind, std::string material,
                                 ParticleShape shape, Real radius) {
  BodyDescription body;
  body.name = std::move(name);
  body.kind = kind;
  body.material = std::move(material);
  body.shape = std::move(shape);
  body.radius = radius;
  return body;
}

/// Returns a simple cubic lattice centred at the origin. x varies fastest.
inline std::vector<Vec3> make_lattice(int nx, int ny, int nz, Real spacing) {
  std::vector<Vec3> points;
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) {
        points.push_back(spacing *
                         Vec3(x - (nx - 1) / 2.0, y - (ny - 1) / 2.0, z - (nz - 1) / 2.0));
      }
    }
  }
  return points;
}

/// Returns springs at rest length between all particles closer than `reach`.
inline std::vector<SpringDescription> join_near(const std::vector<Vec3>& points, Real reach,
                                                const SpringConstants& constants) {
  std::vector<SpringDescription> springs;
  for (Index a = 0; a < points.size(); ++a) {
    for (Index b = a + 1; b < points.size(); ++b) {
      if (distance_between(points[a], points[b]) < reach) springs.push_back({a, b, constants, {}});
    }
  }
  return springs;
}

/// A mass of 1 kg at x = `length`, on a spring of rest length 1 m to a fixed particle at the
/// origin.
inline Scene make_oscillator(IntegratorId integrator, Real step, const SpringConstants& constants,
                             Real length) {
  Scene scene = make_scene(integrator, step);
  scene.materials = {make_material("rubber")};
  ParticleShape shape = make_particles({{0, 0, 0}, {length, 0, 0}}, 1);
  shape.fixed = {0};
  scene.bodies = {make_body("oscillator", BodyKind::deformable, "rubber", shape, 0.01)};
  scene.bodies[0].springs = {{0, 1, constants, 1.0}};
  return scene;
}

/// Creates a simulation. Throws if the scene is invalid.
inline Simulation make_simulation(const Scene& scene, TaskRunner* runner = nullptr) {
  Result<Simulation> result = Simulation::create(scene, runner);
  if (!result) {
    std::string text = "the scene of a test is not valid:";
    for (const Error& error : result.errors()) text += " " + error.path + ": " + error.message;
    throw std::runtime_error(text);
  }
  return std::move(result).value();
}

/// Creates a simulation and takes `steps` steps.
inline Simulation make_advanced(const Scene& scene, std::uint32_t steps) {
  Simulation simulation = make_simulation(scene);
  simulation.advance(steps);
  return simulation;
}

/// Advances to `time`. Throws if the guard acts, which must not happen in a scene that uses this
/// function.
inline void advance_to(Simulation& simulation, Real time) {
  const Real steps = (time - simulation.time()) / simulation.step_size();
  const AdvanceReport report = simulation.advance(static_cast<std::uint32_t>(std::lround(steps)));
  if (!report.events.empty()) throw std::runtime_error("the guard stopped a step");
}

/// Returns the position of a particle of the body with this index in the scene.
inline Vec3 position_of(const Simulation& simulation, std::size_t body, std::size_t particle = 0) {
  return simulation.bodies().at(body).positions[particle];
}
inline Vec3 velocity_of(const Simulation& simulation, std::size_t body, std::size_t particle = 0) {
  return simulation.bodies().at(body).velocities[particle];
}

}  // namespace vat::test
