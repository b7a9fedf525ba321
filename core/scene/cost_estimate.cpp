#include "core/scene/cost_estimate.h"

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

UnitCost particle_cost(const Scene& scene, BodyKind kind) {
  const bool is_incompressible = scene.pressure_solver == PressureSolver::incompressible;
  if (kind == BodyKind::liquid) return is_incompressible ? kIncompressible : kLiquid;
  return kind == BodyKind::deformable ? kDeformable : kRigid;
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
    add(particle_cost(scene, scene.bodies[b].kind), samples[b]->positions.size());
    add(kSpring, samples[b]->springs.size());
  }
  sum.seconds *= evaluations_a_step(scene.numerics.integrator) / scene.numerics.step;
  return sum;
}

}  // namespace vat
