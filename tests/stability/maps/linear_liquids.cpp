#include <algorithm>
#include <cmath>

#include "core/numerics/step_limits.h"
#include "tests/stability/builders.h"
#include "tests/stability/maps/step_map.h"

namespace vat::stability {
namespace {

constexpr int kLatticeEdge = 8;

/// Returns a displacement along x for each particle. It depends on x only and has zero mean, so it
/// contains all waves along an axis. Other waves can grow with any step, since density and pressure
/// have different kernels.
std::vector<Vec3> make_noise(Real size) {
  std::vector<Vec3> noise(kLatticeEdge * kLatticeEdge * kLatticeEdge);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    constexpr Real kLayers[kLatticeEdge] = {1, -0.9, 0.7, -0.8, 0.5, -0.6, 0.8, -0.7};
    noise[i] = {size * kLayers[i % kLatticeEdge], 0, 0};
  }
  return noise;
}

/// Returns the mass of the lattice's particles that gives this density.
Real mass_for(const Scene& scene, Real density) {
  const Simulation simulation = test::make_simulation(scene);
  const BodyView body = simulation.bodies()[0];
  return body.masses[0] * density / simulation.liquid_fields(body.id).value().density[0];
}

/// A liquid of n^3 particles, slightly denser than at rest. The pressure is positive everywhere,
/// and too weak to disturb the lattice during the run.
LinearCase make_liquid(bool is_viscous, Real spacings) {
  constexpr Real kDenser = 1 + 1e-5;
  const Real support = spacings * kSpacing;
  LinearCase linear;
  linear.steps = 80;
  linear.body = std::string(is_viscous ? "viscous liquid" : "sound in a liquid") +
                ", h / dx = " + (spacings > 2 ? "3" : "2");
  linear.displacement = 2e-8;
  linear.scene = make_scene();
  linear.scene.gravity = Vec3::Zero();
  Material& water = linear.scene.materials[0];
  water.liquid = LiquidConstants{is_viscous ? 0.0 : 100.0, is_viscous ? 100.0 : 0.0, support};
  const Real edge = kLatticeEdge * kSpacing;
  linear.scene.periodic = Periodicity{Vec3::Zero(), Vec3::Constant(edge), {true, true, true}};

  linear.rest = test::make_lattice(kLatticeEdge, kLatticeEdge, kLatticeEdge, kSpacing);
  for (Vec3& point : linear.rest) point += Vec3::Constant(edge / 2);
  ParticleShape shape = test::make_particles(linear.rest, 1000 * std::pow(kSpacing, 3));
  linear.scene.bodies = {test::make_body("liquid", BodyKind::liquid, "water", shape, kSpacing / 2)};
  linear.scene.bodies[0].spacing = kSpacing;
  std::get<ParticleShape>(linear.scene.bodies[0].shape)
      .masses.assign(linear.rest.size(), mass_for(linear.scene, kDenser * water.density));
  const SampledBody sample = sample_body(linear.scene.bodies[0], water, 3);
  const SampledBody* const samples[] = {&sample};
  for (const OscillatingPart& part : find_oscillating_parts(linear.scene, samples)) {
    if (part.path == "/bodies/0") linear.modes.push_back(part.bound);
  }
  auto& particles = std::get<ParticleShape>(linear.scene.bodies[0].shape);
  const std::vector<Vec3> noise = make_noise(linear.displacement);
  if (is_viscous) {
    for (const Vec3& v : noise) particles.velocities.push_back(linear.modes[0].rate * v);
  } else {
    for (std::size_t i = 0; i < noise.size(); ++i) particles.positions[i] += noise[i];
  }
  return linear;
}

}  // namespace

std::vector<LinearCase> liquid_cases(bool quick) {
  std::vector<LinearCase> cases;
  for (const bool is_viscous : {false, true}) {
    cases.push_back(make_liquid(is_viscous, 2));
    if (!quick) cases.push_back(make_liquid(is_viscous, 3));
  }
  return cases;
}

}  // namespace vat::stability
