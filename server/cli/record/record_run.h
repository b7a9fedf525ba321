#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/scene/device_choice.h"
#include "core/simulation/simulation.h"
#include "core/support/result.h"
#include "protocol/recording/frame_recorder.h"
#include "protocol/recording/recording_writer.h"
#include "server/cli/simulate/simulate_interrupt.h"
#include "server/cli/simulate/simulate_run.h"
#include "server/recording/resume_state.h"

namespace vat {

/// A run that is recorded.
struct RecordPlan {
  std::string output;  ///< name of the recording
  Schedule schedule;
  RecordingOrder order;
  bool resumes = false;
  DeviceChoice device;
};

/// Result of a run.
struct RecordReport {
  RunTotals totals;
  std::size_t frames = 0;
  std::uint64_t bytes = 0;
  bool is_complete = false;  ///< false: the recording can be resumed
  Status failure;            ///< of the simulation; the recording contains the frames before
};

/// Returns a plan whose frames have equal distances `every` [s] up to the time `until` [s]. Fails
/// if the recording would have too many frames.
Result<Schedule> make_frame_schedule(Real wanted_step, Real every, Real until);

/// Computes a scene and writes its frames. After a signal, completes the recording up to there and
/// writes its state, from which a later call continues. `scene` must have the step of the schedule.
Result<RecordReport> record_scene(const RecordPlan& plan, const Scene& scene,
                                  InstructionSet instructions, TaskRunner& runner,
                                  const InterruptWatch& interrupt);

}  // namespace vat
