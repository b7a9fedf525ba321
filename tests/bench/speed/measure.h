#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "core/support/instruction_set.h"
#include "core/support/result.h"
#include "server/support/stage_clock.h"

namespace vat::bench {

struct SpeedSettings {
  Real warm_up = 1;         ///< [s] simulated before the clock starts, to reach a typical state
  Real measured = 1;        ///< [s] simulated in each repetition
  int repetitions = 5;      ///< each from the same snapshot
  Real longest_time = 120;  ///< [s] of wall time after which no repetition but the first begins
};

/// What a state and its steps are like, whatever the number of threads: means over the measured
/// time; not a number where a scene has no such thing.
struct FlowFigures {
  Real neighbours = 0;              ///< see mean_neighbours()
  Real density_error = 0;           ///< means over its samples: see Diagnostics
  Real greatest_density_error = 0;  ///< mean of the greatest of each sample
  Real velocity_iterations = 0;     ///< of a step's solve, see VolumeReport
  Real place_iterations = 0;
};

struct SpeedRow {
  std::string name;
  std::string solver;  ///< of liquids; empty without
  std::string integrator;
  std::string control;
  std::size_t particles = 0;
  std::size_t liquid_particles = 0;
  std::size_t springs = 0;
  std::size_t threads = 0;
  InstructionSet instructions = InstructionSet::baseline;
  std::vector<Real> seconds;  ///< wall time of each repetition, ascending
  std::uint64_t steps = 0;    ///< of one repetition; where all bodies sleep, those slept through
  std::uint64_t undone_steps = 0;  ///< of them, by the guard
  Real simulated = 0;              ///< [s] of one repetition
  FlowFigures flow;
  /// Of the heap, after all repetitions, without the snapshot that they start from; not a number
  /// where nothing tells.
  Real bytes_per_particle = std::numeric_limits<Real>::quiet_NaN();
  /// The same once diagnostics have been measured, which keep memory of their own.
  Real bytes_with_diagnostics = std::numeric_limits<Real>::quiet_NaN();
  Real creation = 0;                      ///< [s] wall time from scene to simulation
  std::uint64_t state_hash = 0;           ///< after a repetition
  std::vector<StageClock::Stage> stages;  ///< of the fastest repetition

  Real median_seconds() const;
  Real median_ms_per_step() const;
  Real least_ms_per_step() const;
  Real particle_steps_per_second() const;
  Real wall_per_simulated() const;
  Real real_time_factor() const;
};

/// What a scene is run with.
struct SpeedSetup {
  std::vector<std::size_t> threads;  ///< at least one number
  InstructionSet instructions = InstructionSet::baseline;
};

/// Times one scene with each number of threads, in turn. Fails where the scene is invalid, a step
/// fails, or two repetitions end in different states.
Result<std::vector<SpeedRow>> measure(const std::string& name, const Scene& scene,
                                      const SpeedSetup& setup, const SpeedSettings& settings);

struct NamedScene {
  std::string name;
  Scene scene;
};

/// The same of several scenes that take turns, so that their ratios belong to one run: all rows of
/// the first, then those of the next. Their memory is not told apart.
Result<std::vector<SpeedRow>> measure_in_turn(const std::vector<NamedScene>& scenes,
                                              const SpeedSetup& setup,
                                              const SpeedSettings& settings);

}  // namespace vat::bench
