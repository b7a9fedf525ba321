#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/simulation/simulation.h"

/// Scenes that a simulation has every reason to fail on, and what must not happen to any of them.
namespace vat::stability {

/// How the run of a scene ends.
enum class Ending : std::uint8_t {
  ran,      ///< to its end
  stopped,  ///< by the guard, with an event, at the last good state
  refused,  ///< before it began, with a message
  broken,   ///< none of these: see Outcome::fault
};
const char* to_string(Ending ending);

/// What a scene is expected to end in.
enum class Expected : std::uint8_t {
  runs,
  may_stop,  ///< its step cannot bear it: the guard may end it
  refusal,
};

struct AdversarialCase {
  std::string group;  ///< the set-up
  std::string name;   ///< the set-up with its parameters
  Scene scene;
  Expected expected = Expected::runs;
  Real duration = 0.5;                                        ///< [s], at least one tick
  std::function<void(Simulation&, std::uint32_t)> command{};  ///< before each tick, with its number
  std::function<std::string(const Simulation&)> judge{};      ///< of its end; says what is wrong
};

struct Outcome {
  Ending ending = Ending::broken;
  std::string fault;             ///< what must not happen and did; empty where all is well
  std::string message;           ///< first event or error
  std::uint64_t steps = 0;       ///< asked for and taken
  std::uint64_t attempts = 0;    ///< steps and parts of steps taken, undone ones included
  std::uint64_t undone = 0;      ///< steps and parts undone, each with an event
  std::size_t particles = 0;     ///< at the end
  std::size_t non_finite = 0;    ///< values of the state seen
  std::uint64_t wall_stops = 0;  ///< of particles and rigid bodies that a step took beyond a wall
  std::size_t most_outside = 0;  ///< particles beyond a wall at the end of a tick: a fault
  std::uint64_t hash = 0;        ///< of the last state
};

/// Runs the case tick by tick. Whatever happens, nothing is thrown.
Outcome run(const AdversarialCase& adversarial, TaskRunner* runner = nullptr);

/// Every case, in at least 60 groups; small enough for a test suite.
std::vector<AdversarialCase> adversarial_cases();
/// Cases for a long run alone: of 10^5 particles.
std::vector<AdversarialCase> large_adversarial_cases();
/// The cases with each of the other integrators, of the groups whose steps these can take.
std::vector<AdversarialCase> with_other_integrators(const std::vector<AdversarialCase>& cases);

}  // namespace vat::stability
