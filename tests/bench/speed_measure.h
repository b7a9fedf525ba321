#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/scene/scene.h"
#include "core/support/instruction_set.h"
#include "core/support/result.h"

namespace vat::bench {

struct SpeedSettings {
  Real warm_up = 1;     ///< [s] simulated before the clock starts, to reach a typical state
  Real measured = 1;    ///< [s] simulated in each repetition
  int repetitions = 5;  ///< each from the same snapshot
};

struct SpeedRow {
  std::string scene;
  std::string integrator;
  std::size_t particles = 0;
  std::size_t springs = 0;
  std::size_t threads = 0;
  InstructionSet instructions = InstructionSet::baseline;
  std::uint64_t steps = 0;  ///< of one repetition
  Real simulated = 0;       ///< [s] of one repetition
  Real median_ms_per_step = 0;
  Real min_ms_per_step = 0;
  std::uint64_t state_hash = 0;  ///< after a repetition

  Real particle_steps_per_second() const;
  Real real_time_factor() const;
};

/// Times one scene with one number of threads. Fails where the scene is invalid, a step fails, or
/// two repetitions end in different states.
Result<SpeedRow> measure(const Scene& scene, std::size_t threads, const SpeedSettings& settings);

}  // namespace vat::bench
