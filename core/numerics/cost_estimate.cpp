#include "core/numerics/cost_estimate.h"
#include "core/laws/surface_tension.h"
#include "core/scene/lookup.h"
#include "core/support/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vat {
namespace {

/// Cost of a particle or a spring, with all data stored for it.
struct UnitCost {
  Real memory;                 ///< [bytes]
  Real seconds;                ///< for one force evaluation
  Real neighbour_seconds = 0;  ///< the same, for each neighbour of a liquid particle
};

// Slopes between scenes of 1 000 and 64 000 particles. The times of liquids are from scenes of 4000
// particles in two and three dimensions, with support radii of two and three spacings.
constexpr UnitCost kGas{570, 2.5e-7, 1.2e-8};
constexpr UnitCost kTait{570, 1e-7, 2.6e-9};
constexpr UnitCost kIncompressible{1200, 6e-7, 4e-8};
constexpr UnitCost kDeformable{400, 2e-8};
constexpr UnitCost kSpring{300, 1.3e-8};
constexpr UnitCost kRigid{360, 2e-8};
// Cost of surface tension, relative to the cost of the neighbours of a liquid.
constexpr Real kCurvatureShare = 2;   // four passes over the neighbours, compared with two
constexpr Real kCohesionShare = 0.5;  // of the neighbours within twice the support radius

// Support radius of the finest lattice for which kernels are made.
constexpr Real kMaxSpacings = 8;

const UnitCost& unit_cost(PressureSolver solver) {
  switch (solver) {
    case PressureSolver::gas:
      return kGas;
    case PressureSolver::tait:
      return kTait;
    case PressureSolver::incompressible:
      break;
  }
  return kIncompressible;
}

/// Number of lattice points within `reach` spacings.
Real lattice_neighbours(Real reach, int dimensions) {
  constexpr Real kPi = std::numbers::pi_v<Real>;
  return dimensions == 2 ? kPi * reach * reach : 4 * kPi / 3 * reach * reach * reach;
}

/// Cost of a liquid particle. The time depends on its neighbours.
UnitCost liquid_cost(const Scene& scene, const BodyDescription& body, const SampledBody& sample) {
  const Material& material = material_of(scene, body);
  const LiquidConstants& liquid = *material.liquid;
  const int dimensions = scene.dimensions;
  const Real mass = std::ranges::min(sample.masses);
  const Real spacing = std::pow(mass / material.density, Real(1) / dimensions);
  const Real reach = std::min(liquid.support_radius / spacing, kMaxSpacings);
  Real neighbours = lattice_neighbours(reach, dimensions);
  if (liquid.surface_tension > 0) {
    neighbours *= scene.surface_model == SurfaceModel::cohesion
                      ? 1 + kCohesionShare * std::pow(2, dimensions)
                      : 1 + kCurvatureShare;
  }
  UnitCost cost = unit_cost(scene.pressure_solver);
  cost.seconds += neighbours * cost.neighbour_seconds;
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
