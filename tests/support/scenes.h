#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/simulation/simulation.h"

/// Small scenes as values. Bodies are given particle by particle, so that no test of the core
/// depends on the sampler.
namespace vat::test {

inline constexpr std::array kIntegrators = {
    IntegratorId::explicit_euler, IntegratorId::symplectic_euler, IntegratorId::velocity_verlet,
    IntegratorId::heun, IntegratorId::runge_kutta_4};

/// No bodies, no gravity, no vat, and a tick of one step.
inline Scene make_scene(IntegratorId integrator, Real step) {
  Scene scene;
  scene.name = "test";
  scene.pressure_solver = PressureSolver::gas;
  scene.gravity = Vec3::Zero();
  scene.numerics = {integrator, step, step};
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

/// Simple cubic lattice about the origin, x fastest.
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

/// Springs at rest between all particles nearer than `reach`.
inline std::vector<SpringDescription> join_near(const std::vector<Vec3>& points, Real reach,
                                                const SpringConstants& constants) {
  std::vector<SpringDescription> springs;
  for (Index a = 0; a < points.size(); ++a) {
    for (Index b = a + 1; b < points.size(); ++b) {
      if ((points[a] - points[b]).norm() < reach) springs.push_back({a, b, constants, {}});
    }
  }
  return springs;
}

/// The scene must be valid.
inline Simulation make_simulation(const Scene& scene, TaskRunner* runner = nullptr) {
  Result<Simulation> result = Simulation::create(scene, runner);
  if (!result) {
    std::string text = "the scene of a test is not valid:";
    for (const Error& error : result.errors()) text += " " + error.path + ": " + error.message;
    throw std::runtime_error(text);
  }
  return std::move(result).value();
}

/// Advances to `time`; throws where the guard had to step in, which no scene of a test that uses
/// this may need.
inline void advance_to(Simulation& simulation, Real time) {
  const Real steps = (time - simulation.time()) / simulation.step_size();
  const AdvanceReport report = simulation.advance(static_cast<std::uint32_t>(std::lround(steps)));
  if (!report.events.empty()) throw std::runtime_error("the guard stopped a step");
}

/// State of one particle of the body with this place in the scene.
inline Vec3 position_of(const Simulation& simulation, std::size_t body, std::size_t particle = 0) {
  return simulation.bodies().at(body).positions[particle];
}
inline Vec3 velocity_of(const Simulation& simulation, std::size_t body, std::size_t particle = 0) {
  return simulation.bodies().at(body).velocities[particle];
}

}  // namespace vat::test
