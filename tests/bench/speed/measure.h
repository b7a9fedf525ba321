#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/device_choice.h"
#include "core/scene/scene.h"
#include "core/support/instruction_set.h"
#include "core/support/result.h"
#include "server/support/stage_clock.h"

namespace vat::bench {

struct SpeedSettings {
  Real warm_up = 1;         ///< [s] simulated before timing, to reach a typical state
  Real measured = 1;        ///< [s] simulated per repetition
  int repetitions = 5;      ///< each starts from the same snapshot
  Real longest_time = 120;  ///< [s] wall time after which no further repetition starts
};

/// Properties of a scene's state and steps that do not depend on the number of threads: means over
/// the measured time. Not a number if they do not apply.
struct FlowFigures {
  Real neighbours = 0;              ///< see mean_neighbours()
  Real density_error = 0;           ///< mean over the samples; see Diagnostics
  Real greatest_density_error = 0;  ///< mean of the maximum of each sample
  Real velocity_iterations = 0;     ///< iterations per solve, see VolumeReport
  Real place_iterations = 0;
};

struct SpeedRow {
  std::string name;
  std::string solver;  ///< pressure solver; empty without liquid
  std::string integrator;
  std::string control;
  std::size_t particles = 0;
  std::size_t liquid_particles = 0;
  std::size_t springs = 0;
  std::size_t threads = 0;  ///< 0 on a device
  InstructionSet instructions = InstructionSet::baseline;
  std::string device;              ///< see to_text(DeviceChoice); empty: the CPU
  std::vector<Real> seconds;       ///< wall times of the repetitions, ascending
  std::uint64_t steps = 0;         ///< per repetition; if all bodies sleep, the skipped steps
  std::uint64_t undone_steps = 0;  ///< steps that the guard undid
  Real simulated = 0;              ///< [s] per repetition
  FlowFigures flow;
  /// Heap after all repetitions, without the initial snapshot. Not a number if it is unknown.
  Real bytes_per_particle = std::numeric_limits<Real>::quiet_NaN();
  /// Heap after measuring diagnostics, which allocate memory.
  Real bytes_with_diagnostics = std::numeric_limits<Real>::quiet_NaN();
  Real creation = 0;                      ///< [s] wall time of creating the simulation
  std::uint64_t state_hash = 0;           ///< after a repetition
  std::vector<StageClock::Stage> stages;  ///< of the fastest repetition

  /// Returns the device, or the instruction set.
  std::string arithmetic() const;
  Real median_seconds() const;
  Real median_ms_per_step() const;
  Real least_ms_per_step() const;
  Real particle_steps_per_second() const;
  Real wall_per_simulated() const;
  Real real_time_factor() const;
};

/// Conditions of a measurement.
struct SpeedSetup {
  std::vector<std::size_t> threads;  ///< not empty
  InstructionSet instructions = InstructionSet::baseline;
  std::optional<DeviceChoice> device{};  ///< absent: the scene's; automatic: the first device
};

/// Times one scene with each number of threads in turn, and then on the device, if any, from the
/// same state. Fails if the scene is invalid, the device lacks a feature of the scene, a step
/// fails, or two repetitions on the CPU or on the device end in different states.
Result<std::vector<SpeedRow>> measure(const std::string& name, const Scene& scene,
                                      const SpeedSetup& setup, const SpeedSettings& settings);

struct NamedScene {
  std::string name;
  Scene scene;
};

/// Times several scenes in turn, so that their ratios belong to one run. Returns all rows of the
/// first scene, then those of the next. The memory includes all scenes.
Result<std::vector<SpeedRow>> measure_in_turn(const std::vector<NamedScene>& scenes,
                                              const SpeedSetup& setup,
                                              const SpeedSettings& settings);

}  // namespace vat::bench
