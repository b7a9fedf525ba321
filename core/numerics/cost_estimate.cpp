#include "core/numerics/cost_estimate.h"

#include <algorithm>
#include <cmath>

namespace vat {
namespace {

/// Of a particle, or of a spring, with all that is kept for it.
struct UnitCost {
  Real memory;   ///< [bytes]
  Real seconds;  ///< of one evaluation of forces
};

// Slopes between blocks of 1 000 and 64 000 particles.
constexpr UnitCost kLiquid{570, 4.6e-7};         // with the neighbours of two spacings
constexpr UnitCost kIncompressible{1200, 2e-6};  // with ten to twenty iterations
constexpr UnitCost kDeformable{400, 2e-8};
constexpr UnitCost kSpring{300, 1.3e-8};
constexpr UnitCost kRigid{360, 2e-8};
// Of a surface, over the time that a liquid takes for its neighbours.
constexpr Real kCurvature = 2;   // four passes over them, for two
constexpr Real kCohesion = 0.5;  // of those within twice the support radius

// Of the neighbours of two spacings: those of a lone particle's own work, and of the finest lattice
// that kernels are made for.
constexpr Real kMinShare = 0.1;
constexpr Real kMaxSpacings = 8;

/// Of a liquid's particle: time goes by its neighbours.
UnitCost liquid_cost(const Scene& scene, const BodyDescription& body, const SampledBody& sample) {
  const Material& material = *std::ranges::find(scene.materials, body.material, &Material::name);
  const LiquidConstants& liquid = *material.liquid;
  const Real dimensions = scene.dimensions;
  const Real mass = std::ranges::min(sample.masses);
  const Real spacing = std::pow(mass / material.density, 1 / dimensions);
  const Real reach = std::min(liquid.support_radius / spacing, kMaxSpacings);
  Real share = std::max(kMinShare, std::pow(reach / 2, dimensions));
  if (liquid.surface_tension > 0) {
    share *= scene.surface_model == SurfaceModel::cohesion ? 1 + kCohesion * std::pow(2, dimensions)
                                                           : 1 + kCurvature;
  }
  const bool is_incompressible = scene.pressure_solver == PressureSolver::incompressible;
  UnitCost cost = is_incompressible ? kIncompressible : kLiquid;
  cost.seconds *= share;
  return cost;
}

UnitCost particle_cost(const Scene& scene, const BodyDescription& body, const SampledBody& sample) {
  if (body.kind == BodyKind::liquid) return liquid_cost(scene, body, sample);
  return body.kind == BodyKind::deformable ? kDeformable : kRigid;
}

Real evaluations_a_step(IntegratorId integrator) {
  if (integrator == IntegratorId::runge_kutta_4) return 4;
  return integrator == IntegratorId::heun ? 2 : 1;
}

}  // namespace

CostEstimate estimate_cost(const Scene& scene, std::span<const SampledBody* const> samples) {
  CostEstimate sum;
  const auto add = [&](const UnitCost& cost, std::size_t count) {
    sum.memory += cost.memory * static_cast<Real>(count);
    sum.seconds += cost.seconds * static_cast<Real>(count);
  };
  for (std::size_t b = 0; b < samples.size(); ++b) {
    if (samples[b]->positions.empty()) continue;  // an emitter's body
    add(particle_cost(scene, scene.bodies[b], *samples[b]), samples[b]->positions.size());
    add(kSpring, samples[b]->springs.size());
  }
  sum.seconds *= evaluations_a_step(scene.numerics.integrator) / scene.numerics.step;
  return sum;
}

}  // namespace vat
