#include "tests/validation/relax.h"

#include <algorithm>
#include <stdexcept>

namespace vat::validation {

namespace {

constexpr std::uint64_t kMaxSteps = 1'000'000;

ParticleShape& nodes_of(Scene& scene) {
  return std::get<ParticleShape>(scene.bodies.at(0).shape);
}

Real kinetic_energy(const BodyView& body) {
  Real sum = 0;
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    sum += 0.5 * body.masses[i] * body.velocities[i].squaredNorm();
  }
  return sum;
}

/// Returns the largest force that moved the nodes from rest in the first step.
Real greatest_force(const BodyView& body, Real step) {
  Real greatest = 0;
  for (std::size_t i = 0; i < body.masses.size(); ++i) {
    greatest = std::max(greatest, body.masses[i] * body.velocities[i].norm() / step);
  }
  return greatest;
}

/// Sets the rest lengths. Otherwise they would follow from the changed shape.
void keep_rest_lengths(BodyDescription& body) {
  const ParticleShape& nodes = std::get<ParticleShape>(body.shape);
  for (SpringDescription& spring : body.springs) {
    if (spring.rest_length) continue;
    spring.rest_length = (nodes.positions.at(spring.b) - nodes.positions.at(spring.a)).norm();
  }
}

}  // namespace

Equilibrium relax(Scene scene, Real residual, Sheet& sheet) {
  keep_rest_lengths(scene.bodies.at(0));
  scene.numerics.tick = scene.numerics.step;
  Equilibrium result{std::move(scene), 0, {}};
  for (std::uint64_t steps = 0; steps < kMaxSteps;) {
    Run run = sheet.start(result.scene);
    const Real step = run.simulation().step_size();
    run.advance_to(step);
    result.residual = greatest_force(run.body(), step);
    Real energy = kinetic_energy(run.body());
    for (Real last = 0; energy > last && result.residual > residual;) {
      last = energy;
      run.advance_to(run.simulation().time() + step);
      energy = kinetic_energy(run.body());
    }
    steps += run.steps();
    result.origin.seconds += run.seconds();
    result.origin.state_hash = run.state_hash();
    if (result.residual <= residual) return result;
    const BodyView body = run.body();
    nodes_of(result.scene).positions.assign(body.positions.begin(), body.positions.end());
  }
  throw std::runtime_error(result.scene.name + " does not come to rest");
}

}  // namespace vat::validation
