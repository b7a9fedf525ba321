#include "tests/validation/cases/liquid/liquid_rest.h"

#include <cmath>
#include <numbers>

#include "tests/validation/run.h"

namespace vat::validation {

Real lattice_density(int dimensions, Real support_over_spacing) {
  const Real h = support_over_spacing;
  const Real scale = dimensions == 3 ? 315 / (64 * std::numbers::pi * std::pow(h, 9))
                                     : 4 / (std::numbers::pi * std::pow(h, 8));
  const int reach = static_cast<int>(std::ceil(h));
  const int depth = dimensions == 3 ? reach : 0;
  Real sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -depth; j <= depth; ++j) {
      for (int k = -reach; k <= reach; ++k) {
        const Real rest = h * h - (i * i + j * j + k * k);
        if (rest > 0) sum += scale * rest * rest * rest;
      }
    }
  }
  return sum;
}

void set_rest_mass(Scene& scene) {
  BodyDescription& body = scene.bodies[0];
  const Material& material = scene.materials[0];
  const Real reach = material.liquid->support_radius / body.spacing;
  body.mass.reset();
  if (scene.pressure_solver == PressureSolver::tait) return;
  const auto count = static_cast<Real>(Run(scene).body().positions.size());
  body.mass = count * material.density * std::pow(body.spacing, scene.dimensions) /
              lattice_density(scene.dimensions, reach);
}

void set_spacing(Scene& scene, Real spacing) {
  scene.materials[0].liquid->support_radius *= spacing / scene.bodies[0].spacing;
  scene.bodies[0].spacing = spacing;
  set_rest_mass(scene);
}

void set_walls_like_liquid(Scene& scene) {
  const BodyDescription& body = scene.bodies[0];
  const Material& material = scene.materials[0];
  const Real mass = material.density * std::pow(body.spacing, scene.dimensions);
  const Real stiffness = mass * material.liquid->stiffness / (body.spacing * body.spacing);
  scene.interfaces[0].constants = {stiffness, 0.2 * std::sqrt(stiffness * mass)};
}

Real artificial_viscosity(const Scene& scene, Real alpha) {
  const LiquidConstants& liquid = *scene.materials[0].liquid;
  return alpha * std::sqrt(liquid.stiffness) * liquid.support_radius / (2 * (scene.dimensions + 2));
}

Real pressed_height(Real thickness, Real above, Real c2) {
  const auto power = [&](Real depth) { return std::pow(1 + 7 * kGravity * depth / c2, 6.0 / 7); };
  return c2 / (6 * kGravity) * (power(above + thickness) - power(above));
}

Real acoustic_step(const Scene& scene, Real interval) {
  const LiquidConstants& liquid = *scene.materials[0].liquid;
  const Real part = scene.pressure_solver == PressureSolver::tait ? 0.4 : 0.2;
  const Real longest = part * liquid.support_radius / std::sqrt(liquid.stiffness);
  return interval / std::ceil(interval / longest);
}

}  // namespace vat::validation
