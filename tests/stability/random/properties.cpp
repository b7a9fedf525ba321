#include "tests/stability/random/properties.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "core/simulation/simulation.h"
#include "tests/stability/builders.h"
#include "tests/stability/ledger.h"
#include "tests/support/thread_runner.h"

namespace vat::stability {
namespace {

bool is_finite(const Diagnostics& now) {
  const bool energies = std::isfinite(now.kinetic_energy) && std::isfinite(now.elastic_energy) &&
                        std::isfinite(now.contact_energy) && std::isfinite(now.max_density_error);
  return energies && std::ranges::all_of(now.bodies, [](const BodyDiagnostics& body) {
           return body.center_of_mass.allFinite() && body.linear_momentum.allFinite() &&
                  body.angular_momentum.allFinite();
         });
}

std::string property_number(Real value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Runs step by step, with balances of momentum and energy.
std::string run_with_ledger(Simulation& simulation, std::uint32_t steps, PropertyReport& report,
                            std::optional<Snapshot>& densest) {
  Ledger ledger(simulation);
  for (std::uint32_t n = 0; n < steps; ++n) {
    const AdvanceReport advance = simulation.advance(1);
    report.attempts += advance.steps;
    report.undone += advance.undone_steps;
    report.wall_stops += advance.wall_stops;
    if (advance.failed) {
      return std::string("stopped: ") + to_string(advance.events.back().cause);
    }
    const Diagnostics now = simulation.diagnostics();
    if (!is_finite(now)) return "not finite";
    report.outside = now.particles_outside;
    if (now.particles_outside > 0) {
      return std::to_string(now.particles_outside) + " particles outside";
    }
    ledger.add_step(simulation, now);
    if (!densest || now.contact_energy > report.contact_energy) {
      densest = simulation.snapshot();
      report.contact_energy = now.contact_energy;
    }
  }
  report.momentum_error = ledger.momentum_error();
  report.momentum_bound = ledger.momentum_bound();
  report.energy_excess = ledger.energy_excess();
  report.energy_bound = ledger.energy_bound();
  return {};
}

std::string judge_budgets(const Scene& scene, const PropertyReport& report) {
  // Divided steps have another quadrature than the ledger. The ledger also excludes impulses of
  // hard walls.
  if (report.undone > 0 || report.wall_stops > 0) return {};
  if (report.has_momentum_budget && report.momentum_error > report.momentum_bound) {
    return "momentum does not add up: " + property_number(report.momentum_error);
  }
  const IntegratorId integrator = scene.numerics.integrator;
  const bool grows = integrator == IntegratorId::explicit_euler || integrator == IntegratorId::heun;
  if (!grows && report.energy_excess > report.energy_bound) {
    return "energy grows by " + property_number(report.energy_excess) + ", bound " +
           property_number(report.energy_bound);
  }
  return {};
}

std::string judge_threads(const Scene& scene, std::uint32_t steps, std::uint64_t hash) {
  for (const std::size_t threads : {2U, 4U}) {
    test::ThreadRunner runner(threads);
    Simulation simulation = test::make_simulation(scene, &runner);
    simulation.advance(steps);
    if (simulation.state_hash() != hash) {
      return std::to_string(threads) + " threads give other bits than one";
    }
  }
  return {};
}

std::string judge_snapshot(Simulation& simulation, const Snapshot& snapshot) {
  constexpr std::uint32_t kSteps = 10;
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    simulation.restore(snapshot);
    simulation.advance(kSteps);
    hash = simulation.state_hash();
    simulation.advance(kSteps);  // moves away from the snapshot
  }
  return hashes[0] == hashes[1] ? "" : "going back to a snapshot gives other bits";
}

std::string check(const Scene& scene, std::uint32_t steps, PropertyReport& report) {
  constexpr std::uint32_t kThreadedSteps = 30;
  Result<Simulation> created = Simulation::create(scene);
  if (!created) return "refused: " + created.errors().front().message;
  Simulation& simulation = created.value();
  report.particles = simulation.particle_count();
  report.has_momentum_budget = Ledger::closes(scene);
  std::optional<Snapshot> densest;
  std::string fault = run_with_ledger(simulation, steps, report, densest);
  report.hash = simulation.state_hash();
  if (fault.empty()) fault = judge_budgets(scene, report);
  if (fault.empty() && densest) fault = judge_snapshot(simulation, *densest);
  if (fault.empty()) {
    Simulation serial = test::make_simulation(scene);
    serial.advance(std::min(steps, kThreadedSteps));
    fault = judge_threads(scene, std::min(steps, kThreadedSteps), serial.state_hash());
  }
  return fault;
}

}  // namespace

PropertyReport check_properties(const Scene& scene, Real duration, std::uint32_t most_steps) {
  PropertyReport report;
  try {
    const Real steps = std::min<Real>(std::ceil(duration / scene.numerics.step), most_steps);
    report.fault = check(scene, static_cast<std::uint32_t>(steps), report);
  } catch (const std::exception& error) {
    report.fault = std::string("threw: ") + error.what();
  }
  return report;
}

}  // namespace vat::stability
