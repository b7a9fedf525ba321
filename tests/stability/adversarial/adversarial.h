#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/simulation/simulation.h"

/// Scenes on which a simulation may fail, and the conditions that must hold for all of them.
namespace vat::stability {

/// The end of a run.
enum class Ending : std::uint8_t {
  ran,      ///< reached its end
  stopped,  ///< the guard stopped it with an event at the last valid state
  refused,  ///< refused with a message before its start
  broken,   ///< any other end: see Outcome::fault
};
const char* to_string(Ending ending);

/// The expected end of a run.
enum class Expected : std::uint8_t {
  runs,
  may_stop,  ///< the step is too long, so the guard may stop the run
  refusal,
};

struct AdversarialCase {
  std::string group;  ///< the setup
  std::string name;   ///< the setup with its parameters
  Scene scene;
  Expected expected = Expected::runs;
  Real duration = 0.5;  ///< [s], at least one tick
  std::function<void(Simulation&, std::uint32_t)>
      command{};  ///< called before each tick with its number
  std::function<std::string(const Simulation&)>
      judge{};  ///< returns a fault of the end state, or ""
};

struct Outcome {
  Ending ending = Ending::broken;
  std::string fault;             ///< violated condition; empty if none
  std::string message;           ///< first event or error
  std::uint64_t steps = 0;       ///< requested and completed
  std::uint64_t attempts = 0;    ///< steps and parts of steps, including undone ones
  std::uint64_t undone = 0;      ///< undone steps and parts, each with an event
  std::size_t particles = 0;     ///< at the end
  std::size_t non_finite = 0;    ///< number of non-finite values in the states
  std::uint64_t wall_stops = 0;  ///< particles and rigid bodies that a step moved beyond a wall
  std::size_t most_outside = 0;  ///< particles beyond a wall at the end of a tick; must be 0
  std::uint64_t hash = 0;        ///< hash of the last state
};

/// Runs the case tick by tick. Does not throw.
Outcome run(const AdversarialCase& adversarial, TaskRunner* runner = nullptr);

/// Returns all cases of the test suite, in at least 60 groups.
std::vector<AdversarialCase> adversarial_cases();
/// Returns cases of 10^5 particles for long runs.
std::vector<AdversarialCase> large_adversarial_cases();
/// Returns the cases with each of the other integrators, for groups whose steps these integrators
/// support.
std::vector<AdversarialCase> with_other_integrators(const std::vector<AdversarialCase>& cases);
/// Returns the cases in which solids take sub-steps, for all scenes that local steps support. The
/// same conditions must hold, without `judge`.
std::vector<AdversarialCase> with_sub_steps(const std::vector<AdversarialCase>& cases);

}  // namespace vat::stability
