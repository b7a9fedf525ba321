#include "tests/stability/adversarial/adversarial.h"

#include <algorithm>
#include <cmath>
#include <exception>

namespace vat::stability {
namespace {

/// The guard tries a step in one, two, four and eight parts, and then gives up.
constexpr std::uint64_t kMaxAttempts = 1 + 2 + 4 + 8;

std::size_t count_non_finite(const Simulation& simulation) {
  std::size_t count = 0;
  for (const BodyView& body : simulation.bodies()) {
    for (const auto& column : {body.positions, body.velocities}) {
      count += static_cast<std::size_t>(
          std::ranges::count_if(column, [](const Vec3& v) { return !v.allFinite(); }));
    }
    if (body.pose &&
        !(body.pose->orientation.coeffs().allFinite() && body.pose->angular_velocity.allFinite())) {
      ++count;
    }
  }
  return count;
}

std::string describe(const Errors& errors) {
  return errors.front().path + ": " + errors.front().message;
}

std::string describe(const GuardEvent& event) {
  return std::string(to_string(event.cause)) + " at " + std::to_string(event.time) + " s";
}

/// Adds the state of a simulation after a tick to the outcome.
void observe(const Simulation& simulation, Outcome& outcome) {
  const Diagnostics now = simulation.diagnostics();
  outcome.particles = simulation.particle_count();
  outcome.non_finite += count_non_finite(simulation);
  outcome.most_outside = std::max(outcome.most_outside, now.particles_outside);
  outcome.hash = simulation.state_hash();
  if (outcome.non_finite > 0) outcome.fault = "a value that is not finite";
  if (!std::isfinite(now.kinetic_energy)) outcome.fault = "an energy that is not finite";
  if (now.particles_outside > 0) {
    outcome.fault = std::to_string(now.particles_outside) + " particles outside the vat";
  }
}

/// Runs one tick. Returns true if the run can continue.
bool take_tick(const AdversarialCase& adversarial, Simulation& simulation, Outcome& outcome) {
  const std::uint64_t before = simulation.state_hash();
  const Real start = simulation.time();
  const std::uint32_t steps = simulation.steps_per_tick();
  const AdvanceReport report = simulation.advance(steps);
  outcome.attempts += report.steps;
  outcome.undone += report.undone_steps;
  outcome.wall_stops += report.wall_stops;
  // Local steps are also divided without the guard.
  const bool is_fixed = adversarial.scene.numerics.control == StepControl::fixed;
  if (is_fixed && report.steps > kMaxAttempts * steps) outcome.fault = "too many attempts";
  if (!report.events.empty() && outcome.message.empty()) {
    outcome.message = describe(report.events.front());
  }
  if (report.failed) {
    outcome.ending = Ending::stopped;
    if (report.events.empty() || report.events.back().recovered) {
      outcome.fault = "stopped without an event that says why";
    }
    if (simulation.state_hash() != before) outcome.fault = "did not go back to the last good state";
    if (adversarial.expected == Expected::runs) outcome.fault = "stopped: " + outcome.message;
    return false;
  }
  outcome.steps += steps;
  if (!(simulation.time() > start)) outcome.fault = "time does not go on";
  observe(simulation, outcome);
  return outcome.fault.empty();
}

void run_created(const AdversarialCase& adversarial, Simulation& simulation, Outcome& outcome) {
  observe(simulation, outcome);
  const Real tick = simulation.step_size() * simulation.steps_per_tick();
  const auto ticks = static_cast<std::uint32_t>(std::max(1.0, adversarial.duration / tick));
  for (std::uint32_t n = 0; n < ticks; ++n) {
    if (adversarial.command) adversarial.command(simulation, n);
    if (!take_tick(adversarial, simulation, outcome)) return;
  }
  outcome.ending = Ending::ran;
  if (adversarial.judge) outcome.fault = adversarial.judge(simulation);
}

}  // namespace

const char* to_string(Ending ending) {
  switch (ending) {
    case Ending::ran:
      return "ran";
    case Ending::stopped:
      return "stopped";
    case Ending::refused:
      return "refused";
    case Ending::broken:
      return "broken";
  }
  return "";
}

Outcome run(const AdversarialCase& adversarial, TaskRunner* runner) {
  Outcome outcome;
  try {
    Result<Simulation> created = Simulation::create(adversarial.scene, runner);
    if (!created) {
      outcome.ending = Ending::refused;
      outcome.message = describe(created.errors());
      if (adversarial.expected != Expected::refusal) outcome.fault = "refused: " + outcome.message;
      return outcome;
    }
    if (adversarial.expected == Expected::refusal) outcome.fault = "the scene was not refused";
    if (outcome.fault.empty()) run_created(adversarial, created.value(), outcome);
  } catch (const std::exception& error) {
    outcome.ending = Ending::broken;
    outcome.fault = std::string("threw: ") + error.what();
  }
  return outcome;
}

}  // namespace vat::stability
