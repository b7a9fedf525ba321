#include "tests/bench/instructions/counted_scenes.h"

#include <cmath>

#include "core/simulation/simulation.h"
#include "server/cli/simulate/simulate_run.h"
#include "tests/bench/speed/scenes.h"

extern "C" {
/// A separate function with an unmangled name, so that callgrind finds it.
[[gnu::noinline]] void vat_counted_steps(vat::Simulation* simulation, std::uint32_t steps,
                                         vat::AdvanceReport* report) {
  *report = simulation->advance(steps);
}
}

namespace vat::bench {

namespace {

std::uint32_t steps_of(const Simulation& simulation, Real interval) {
  return static_cast<std::uint32_t>(std::lround(interval / simulation.step_size()));
}

}  // namespace

const std::vector<CountedScene>& counted_scenes() {
  static const std::vector<CountedScene> kScenes = {
      {"liquid-tait", [] { return dam_break(6, PressureSolver::tait); }, 0.1, 0.1},
      {"liquid-incompressible", [] { return dam_break(6, PressureSolver::incompressible); }, 0.1,
       0.05},
      {"rigid", [] { return rigid_pile(25, InterfaceLaw::penalty); }, 0.2, 0.1},
      {"deformable", [] { return deformable_pile(6); }, 0.2, 0.1},
  };
  return kScenes;
}

Result<CountedRun> run_counted(const CountedScene& scene) {
  Result<Simulation> created = Simulation::create(scene.make(), nullptr, InstructionSet::baseline);
  if (!created) return created.errors();
  Simulation& simulation = created.value();
  AdvanceReport report = simulation.advance(steps_of(simulation, scene.warm_up));
  if (!report.failed) {
    vat_counted_steps(&simulation, steps_of(simulation, scene.counted), &report);
  }
  if (report.failed) return describe(report.events.back(), simulation);
  return CountedRun{simulation.particle_count(), report.steps};
}

}  // namespace vat::bench
