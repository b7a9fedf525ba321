#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "core/device/device_use.h"
#include "core/limits.h"
#include "core/numerics/choose_numerics.h"
#include "core/threads/thread_pool.h"
#include "protocol/scene/scene_json.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"
#include "server/cli/common/option_checks.h"
#include "server/cli/common/scene_argument.h"
#include "server/cli/record/record_run.h"
#include "server/cli/simulate/simulate_schedule.h"
#include "server/operations/choose_device.h"

namespace vat {
namespace {

constexpr Real kDefaultEnd = 10;  // [s]
constexpr Real kMaxEnd = 1e6;     // [s]
constexpr std::size_t kMaxRecordThreads = 256;
constexpr std::size_t kMaxKeyEvery = 1000;

constexpr const char* kRecordFooter =
    R"(A viewer shows the recording without a server: drop the file on its page, or see vat export. The
frames are those of a live session. A frame states its maximum position error, by default 1/64 of
the particle distance. More key frames make the file larger and seeking faster.

SIGINT and SIGTERM complete the recording up to the present frame and write the state to
NAME.vatrec.state. The same command with --resume continues from there: the finished file has the
same bytes as a file of an uninterrupted run.

Exit codes: 0 success, 1 invalid scene or failed run, 2 wrong usage, 128 + n interrupted by signal n.)";

struct RecordOptions {
  std::string scene;
  std::string scenes_folder = installed_scenes_folder();
  Level level = Level::normal;
  std::string output;
  Real until = kDefaultEnd;
  std::optional<Real> every;
  std::optional<Real> max_error;
  std::optional<std::uint64_t> key_every;
  std::size_t threads =
      std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, kMaxRecordThreads);
  InstructionSet instructions = best_instruction_set();
  std::optional<DeviceChoice> device;  ///< absent: the scene's
  bool resume = false;
};

RecordingOrder order_of(const RecordOptions& options, const Scene& scene, const Schedule& schedule,
                        const DeviceChoice& device) {
  RecordingOrder order;
  order.program = VAT_VERSION;
  order.instruction_set = to_string(options.instructions);
  if (!device.is_cpu) {
    order.instruction_set += std::string(", opencl-") + to_string(device.arithmetic);
  }
  order.scene = write_scene(scene).dump();
  order.frame_seconds = schedule.step * static_cast<Real>(schedule.steps_per_output);
  order.step = schedule.step;
  order.max_error = options.max_error;
  order.key_every = options.key_every;
  return order;
}

void print_record(const RecordOptions& options, const RecordReport& report) {
  std::cerr << options.output << ": " << report.frames << " frames, " << std::fixed
            << std::setprecision(1) << static_cast<double>(report.bytes) / 1e6 << " MB; "
            << report.totals.steps << " steps in " << report.totals.stepping.count() << " s\n";
}

/// Returns the device of the steps. An automatic choice depends on the start of the scene.
Result<DeviceChoice> device_of_run(const RecordOptions& options, const Scene& scene,
                                   TaskRunner& runner) {
  const DeviceChoice wanted = device_for(options.device, scene);
  if (!wanted.is_auto) return wanted;
  const Result<Simulation> simulation = Simulation::create(scene, &runner, options.instructions);
  if (!simulation) return simulation.errors();
  return choose_device(wanted, simulation.value(), runner);
}

int record(const RecordOptions& options) {
  Result<Scene> loaded = load_scene(options.scene, options.scenes_folder, options.level);
  if (!loaded) return fail(options.scene, loaded.errors());
  Scene& scene = loaded.value();
  resolve_accuracy(scene);
  const Result<Schedule> schedule = make_frame_schedule(
      scene.numerics.step, options.every.value_or(scene.numerics.tick), options.until);
  if (!schedule) return fail(options.scene, schedule.errors());
  for (const std::string& notice : schedule.value().notices) std::cerr << notice << '\n';
  scene.numerics.accuracy.reset();  // the numerics have been chosen
  scene.numerics = with_step(scene.numerics, schedule.value().step);
  print_warnings(options.scene, scene);
  ThreadPoolRunner runner(options.threads);
  const Result<DeviceChoice> device = device_of_run(options, scene, runner);
  if (!device) return fail(options.scene, device.errors());
  const InterruptWatch interrupt;
  const Result<RecordReport> report = record_scene(
      {options.output, schedule.value(), order_of(options, scene, schedule.value(), device.value()),
       options.resume, device.value()},
      scene, options.instructions, runner, interrupt);
  if (!report) return fail(options.scene, report.errors());
  print_record(options, report.value());
  if (!report.value().failure) return fail(options.scene, report.value().failure.errors());
  if (report.value().is_complete) return kExitOk;
  std::cerr << options.scene << ": interrupted; the same command with --resume continues\n";
  return kExitSignal + interrupt.signal();
}

std::string check_recording_name(const std::string& name) {
  const bool good = std::filesystem::path(name).extension() == ".vatrec";
  return good ? std::string() : "'" + name + "' must end in .vatrec";
}

}  // namespace

void add_record_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("record", "Record the frames of a scene for viewers");
  const auto options = std::make_shared<RecordOptions>();
  command->add_option("scene", options->scene, kSceneHelp)->required();
  command->add_option("--output", options->output, "Recording, in .vatrec")
      ->required()
      ->check(CLI::Validator(check_recording_name, "FILE"));
  command->add_option("--scenes", options->scenes_folder, "Folder of the catalogue");
  command->add_option("--until", options->until, "End of the recording [s]")
      ->check(real_in(0, kMaxEnd))
      ->capture_default_str();
  command
      ->add_option("--every", options->every,
                   "Simulated time between frames [s]; default: the scene's tick")
      ->check(real_in(kMinStep, kMaxEnd));
  command
      ->add_option("--max-error", options->max_error,
                   "Maximum position error [m]; 0: the finest grid; default: 1/64 of the particle "
                   "distance")
      ->check(real_in(0, kMaxLength));
  command
      ->add_option("--key-every", options->key_every,
                   "Frames from one key frame to the next; default: chosen for seeking in 0.1 s")
      ->check(CLI::Range(std::size_t{1}, kMaxKeyEvery));
  command
      ->add_option("--threads", options->threads,
                   "Threads of one step; results do not depend on this number")
      ->check(CLI::Range(std::size_t{1}, kMaxRecordThreads))
      ->capture_default_str();
  add_level_option(*command, options->level);
  add_isa_option(*command, options->instructions);
  add_device_option(*command, options->device);
  command->add_flag("--resume", options->resume, "Continue an interrupted recording");
  command->footer(kRecordFooter);
  command->callback([options, &exit_code] { exit_code = record(*options); });
}

}  // namespace vat
