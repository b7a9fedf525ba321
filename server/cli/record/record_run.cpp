#include "server/cli/record/record_run.h"

#include <cmath>
#include <iostream>
#include <sstream>
#include <utility>

#include "core/device/device_use.h"
#include "protocol/recording/recording_file.h"
#include "server/cli/simulate/simulate_progress.h"

namespace vat {
namespace {

constexpr Real kFrameTolerance = 1e-9;

/// Simulation, frames and file of a run.
struct RecordedRun {
  Simulation simulation;
  FrameRecorder recorder;
  RecordingWriter writer;
  std::uint64_t step = 0;  ///< number of taken steps
  std::vector<std::uint8_t> last_header{};
};

RecorderSettings recorder_settings(const RecordingOrder& order) {
  return {order.frame_seconds, order.max_error, order.key_every};
}

Result<RecordedRun> begin_run(const RecordPlan& plan, const Scene& scene,
                              InstructionSet instructions, TaskRunner& runner) {
  Result<Simulation> simulation = Simulation::create(scene, &runner, instructions);
  if (!simulation) return simulation.errors();
  if (Status used = use_device(plan.device, simulation.value()); !used) return used.errors();
  Result<RecordingWriter> writer = RecordingWriter::create(plan.output);
  if (!writer) return writer.errors();
  return RecordedRun{std::move(simulation).value(), FrameRecorder(recorder_settings(plan.order)),
                     std::move(writer).value()};
}

Status read_last_frames(RecordingFile& file, const ResumeState& state, FrameRecorder& recorder) {
  const std::size_t last = state.frames - 1;
  for (std::size_t f = file.index().key_before(last); f <= last; ++f) {
    const auto frame = file.frame(f);
    if (!frame) return frame.errors();
    if (Status read = recorder.read(frame.value(), f); !read) return read;
  }
  return {};
}

/// Whether the frames before the state are those of the recording.
Result<bool> belongs_to(RecordingFile& file, const ResumeState& state) {
  if (state.frames == 0 || state.frames > file.index().frames().size()) return false;
  const auto last = file.frame(state.frames - 1);
  if (!last) return last.errors();
  return header_of_frame(last.value()) == state.last_header;
}

Result<RecordedRun> resume_run(const RecordPlan& plan, InstructionSet instructions,
                               TaskRunner& runner) {
  const Result<ResumeState> state = read_resume_state(plan.output);
  if (!state) return state.errors();
  if (Status same = check_same(state.value().order, plan.order); !same) return same.errors();
  if (state.value().step > plan.schedule.total_steps) {
    return Error{"other_options", "", "the recording already ends after --until"};
  }
  Result<RecordingFile> file = RecordingFile::open(plan.output);
  if (!file) return file.errors();
  const Result<bool> belongs = belongs_to(file.value(), state.value());
  if (!belongs) return belongs.errors();
  if (!belongs.value()) {
    return Error{"bad_value", resume_name(plan.output), "is not the state of this recording"};
  }
  Result<Simulation> simulation = Simulation::load(state.value().snapshot, &runner, instructions);
  if (!simulation) return simulation.errors();
  if (Status used = resume_device(plan.device, simulation.value()); !used) return used.errors();
  FrameRecorder recorder(recorder_settings(plan.order));
  if (Status read = read_last_frames(file.value(), state.value(), recorder); !read) {
    return read.errors();
  }
  Result<RecordingWriter> writer = RecordingWriter::create(plan.output);
  if (!writer) return writer.errors();
  if (Status copied = writer.value().copy(file.value(), state.value().frames); !copied) {
    return copied.errors();
  }
  return RecordedRun{std::move(simulation).value(), std::move(recorder), std::move(writer).value(),
                     state.value().step, state.value().last_header};
}

Error interruption() {
  return {"interrupted", "", ""};
}

/// Computes and writes the remaining frames. Returns an error with the code "interrupted" after a
/// signal.
Status compute_frames(const RecordPlan& plan, const InterruptWatch& interrupt, RecordedRun& run,
                      RunTotals& totals, Status& write_failure) {
  ProgressBar bar;
  RunHooks hooks;
  hooks.output = [&](const RunTotals&) -> Status {
    const FrameRecorder::Parts parts = run.recorder.record(run.simulation);
    run.last_header = header_of_frame(parts.frame);
    write_failure = run.writer.write(parts);
    if (!write_failure) return write_failure;
    if (interrupt.signal() != 0) return interruption();
    return {};
  };
  hooks.progress = [&](std::uint64_t step, Real time) -> Status {
    run.step = step;
    bar.show(step, plan.schedule.total_steps, time);
    // If a frame is due, the run is interrupted after the frame.
    const bool is_due = step % plan.schedule.steps_per_output == 0;
    if (interrupt.signal() != 0 && !is_due) return interruption();
    return {};
  };
  hooks.notice = [&bar](const std::string& text) {
    bar.clear();
    std::cerr << text << '\n';
  };
  return vat::run(run.simulation, plan.schedule, hooks, totals, run.step);
}

Status finish_recording(const RecordPlan& plan, RecordedRun& run, bool is_interrupted) {
  const std::uint64_t frames = run.writer.index().frames().size();
  if (Status finished = run.writer.finish(); !finished) return finished;
  if (!is_interrupted) {
    remove_resume_state(plan.output);
    return {};
  }
  return write_resume_state(plan.output, {plan.order, run.step, frames, run.last_header,
                                          run.simulation.snapshot().to_bytes()});
}

}  // namespace

Result<Schedule> make_frame_schedule(Real wanted_step, Real every, Real until) {
  const Real frames = std::floor(until / every * (1 + kFrameTolerance));
  if (frames + 1 > static_cast<Real>(kMaxRecordedFrames)) {
    return Error{
        "too_large", "--every",
        "the recording would have more than " + std::to_string(kMaxRecordedFrames) + " frames"};
  }
  Schedule schedule = make_schedule(wanted_step, every, frames * every);
  if (frames * every < until * (1 - kFrameTolerance)) {
    std::ostringstream end;
    end << "the recording ends at " << frames * every << " s, after a whole number of frames";
    schedule.notices.push_back(end.str());
  }
  return schedule;
}

Result<RecordReport> record_scene(const RecordPlan& plan, const Scene& scene,
                                  InstructionSet instructions, TaskRunner& runner,
                                  const InterruptWatch& interrupt) {
  Result<RecordedRun> begun = plan.resumes ? resume_run(plan, instructions, runner)
                                           : begin_run(plan, scene, instructions, runner);
  if (!begun) return begun.errors();
  RecordedRun& run = begun.value();
  RecordReport report;
  Status write_failure;
  const Status done = compute_frames(plan, interrupt, run, report.totals, write_failure);
  if (!write_failure) return write_failure.errors();
  const bool is_interrupted = !done && done.errors().front().code == "interrupted";
  report.is_complete = !is_interrupted;
  if (!done && !is_interrupted) report.failure = done;
  report.frames = run.writer.index().frames().size();
  report.bytes = run.writer.index().content_end();
  if (Status finished = finish_recording(plan, run, is_interrupted); !finished)
    return finished.errors();
  return report;
}

}  // namespace vat
