#include "server/operations/machine_speed.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "core/numerics/cost_estimate.h"
#include "core/simulation/simulation.h"
#include "core/support/check.h"

namespace vat {
namespace {

/// A liquid of 4000 particles at rest: large enough for several threads.
Scene measured_scene() {
  constexpr Real kSpacing = 0.05;
  Scene scene;
  Material water;
  water.name = "water";
  water.liquid = LiquidConstants{400, 0.1, 2 * kSpacing, 0.1};
  scene.materials = {water};
  scene.vat.emplace().max = {1, 1, 1};
  scene.numerics.step = 0.001;
  BodyDescription pool;
  pool.name = "pool";
  pool.material = water.name;
  pool.shape = BoxShape{{0.5, 0.5, 0.25}, {1, 1, 0.5}};
  pool.spacing = kSpacing;
  scene.bodies = {pool};
  return scene;
}

/// Seconds per simulated second.
Real estimated_cost(const Scene& scene) {
  const std::vector<SampledBody> bodies = sample_bodies(scene);
  return estimate_cost(scene, pointers_to(bodies)).seconds;
}

/// The cost by the fastest step, which other programs have delayed least.
Real measure_cost(const Scene& scene, TaskRunner* runner, InstructionSet instructions) {
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;
  Result<Simulation> created = Simulation::create(scene, runner, instructions);
  VAT_CHECK(created.ok());
  Simulation& simulation = created.value();
  simulation.advance(2);  // allocates
  Seconds fastest = Seconds::max();
  const Clock::time_point end = Clock::now() + MachineSpeed::kMeasuringTime;
  for (Clock::time_point begin = Clock::now(); begin < end;) {
    simulation.advance(1);
    const Clock::time_point now = Clock::now();
    fastest = std::min<Seconds>(fastest, now - begin);
    begin = now;
  }
  return fastest.count() / scene.numerics.step;
}

}  // namespace

Real MachineSpeed::real_time_factor(const Scene& scene, TaskRunner* runner,
                                    InstructionSet instructions) {
  {
    const std::lock_guard lock(mutex_);
    if (!measured_) {
      const Scene known = measured_scene();
      measured_ = measure_cost(known, runner, instructions) / estimated_cost(known);
    }
  }
  return 1 / (estimated_cost(scene) * *measured_);
}

}  // namespace vat
