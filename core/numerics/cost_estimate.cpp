#include "core/numerics/cost_estimate.h"
#include "core/scene/lookup.h"
#include "core/support/check.h"

#include <algorithm>
#include <cmath>

namespace vat {
namespace {

/// Cost of a particle or a spring, with all data stored for it.
struct UnitCost {
  Real memory;   ///< [bytes]
  Real seconds;  ///< for one force evaluation
};

// Slopes between scenes of 1 000 and 64 000 particles.
constexpr UnitCost kLiquid{570, 4.6e-7};         // with the neighbours within two spacings
constexpr UnitCost kIncompressible{1200, 2e-6};  // with 10 to 20 iterations
constexpr UnitCost kDeformable{400, 2e-8};
constexpr UnitCost kSpring{300, 1.3e-8};
constexpr UnitCost kRigid{360, 2e-8};
// Cost of surface tension, relative to the cost of the neighbours of a liquid.
constexpr Real kCurvature = 2;   // four passes over the neighbours, compared with two
constexpr Real kCohesion = 0.5;  // of the neighbours within twice the support radius

// Relative to the number of neighbours within two spacings: the cost of a particle without
// neighbours, and the finest lattice for which kernels are made.
constexpr Real kMinShare = 0.1;
constexpr Real kMaxSpacings = 8;

/// Cost of a liquid particle. The time depends on its neighbours.
UnitCost liquid_cost(const Scene& scene, const BodyDescription& body, const SampledBody& sample) {
  const Material& material = material_of(scene, body);
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
  VAT_CHECK(samples.size() == scene.bodies.size());
  CostEstimate sum;
  const auto add = [&](const UnitCost& cost, std::size_t count) {
    sum.memory += cost.memory * static_cast<Real>(count);
    sum.seconds += cost.seconds * static_cast<Real>(count);
  };
  for (std::size_t b = 0; b < samples.size(); ++b) {
    if (samples[b]->positions.empty()) continue;  // the body of an emitter
    add(particle_cost(scene, scene.bodies[b], *samples[b]), samples[b]->positions.size());
    add(kSpring, samples[b]->springs.size());
  }
  sum.seconds *= evaluations_a_step(scene.numerics.integrator) / scene.numerics.step;
  return sum;
}

}  // namespace vat
