#include "server/operations/scene_speed.h"

#include <algorithm>

#include "core/numerics/cost_estimate.h"
#include "core/simulation/simulation.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// Seconds per simulated second.
Real estimated_cost(const Scene& scene) {
  const std::vector<SampledBody> bodies = sample_bodies(scene);
  return estimate_cost(scene, pointers_to(bodies)).seconds;
}

}  // namespace

Real measure_cost(const Scene& scene, TaskRunner* runner, InstructionSet instructions) {
  using Steady = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<Real>;
  Result<Simulation> created = Simulation::create(scene, runner, instructions);
  VAT_CHECK(created.ok());
  Simulation& simulation = created.value();
  simulation.advance(1);  // allocates
  std::vector<Real> steps;
  const Steady::time_point end = Steady::now() + kMeasuringTime;
  for (Steady::time_point begin = Steady::now(); begin < end;) {
    simulation.advance(1);
    const Steady::time_point now = Steady::now();
    steps.push_back(Seconds(now - begin).count());
    begin = now;
  }
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::ranges::nth_element(steps, middle);
  return *middle / scene.numerics.step;
}

std::vector<Real> real_time_factors(std::span<const Scene> levels,
                                    const std::function<Real(const Scene&)>& measure) {
  if (levels.empty()) return {};
  const Real measured = measure(levels.front());
  VAT_CHECK(measured > 0);
  const Real estimated = estimated_cost(levels.front());
  std::vector<Real> factors;
  for (const Scene& scene : levels) {
    factors.push_back(estimated / (estimated_cost(scene) * measured));
  }
  return factors;
}

}  // namespace vat
