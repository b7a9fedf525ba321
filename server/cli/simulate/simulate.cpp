#include <CLI/CLI.hpp>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/device/device_use.h"
#include "core/limits.h"
#include "core/numerics/choose_numerics.h"
#include "core/simulation/simulation.h"
#include "core/threads/thread_pool.h"
#include "core/validation/validate.h"
#include "protocol/files/text.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"
#include "server/cli/common/option_checks.h"
#include "server/cli/common/scene_argument.h"
#include "server/cli/simulate/simulate_interrupt.h"
#include "server/cli/simulate/simulate_profile.h"
#include "server/cli/simulate/simulate_progress.h"
#include "server/cli/simulate/simulate_run.h"
#include "server/cli/simulate/simulate_schedule.h"
#include "server/operations/choose_device.h"
#include "server/output/diagnostics_writer.h"
#include "server/output/frame_writer.h"

namespace vat {

namespace {

constexpr Real kDefaultUntil = 10;  // [s]
constexpr Real kMaxUntil = 1e6;     // [s] keeps step counts exact in a double, at any step
constexpr std::size_t kMaxThreads = 256;

constexpr const char* kSimulateFooter = R"(Output files
  .csv   one row per particle and output time: time, body, kind, particle, position x y z,
         velocity vx vy vz, density and pressure (empty unless the body is a liquid)
  .pvd   list of compressed VTK files, one per output time (NAME-0000.vtu, NAME-0001.vtu, ...):
         position, velocity, number of the body, kind (0 liquid, 1 deformable, 2 rigid), radius,
         density and pressure (0 unless the body is a liquid). ParaView opens the list
  .ply   binary points in single precision, coloured by kind, one file per output time
  .npy   one array [outputs, particles, 6] of float64: x, y, z, vx, vy, vz; only if the number of
         particles is constant
  .npz   arrays for numpy.load: time, count of particles, body, number in the body, position,
         velocity. Missing particles are -1 and NaN
  .glb   glTF: animated meshes of rigid bodies, and points of the other particles at up to 120
         key frames. With --surface: surfaces of liquids instead of their points
  .abc   Alembic: points with velocities and ids, and rigid bodies as transformations with meshes.
         With --surface: also a mesh per liquid material
Particles are in the order of the scene's bodies. Numbers in text have all digits that
an exact copy needs. All units are SI.

Diagnostics (.csv), one row per output time: time, energies, liquid density error (mean and greatest),
particles outside the vat, particles emitted and drained and guard events so far, and for each body
NAME.mass, centre of mass NAME.x y z, linear and angular momentum about the origin NAME.px py pz lx
ly lz, and for a rigid body the orientation NAME.qw qx qy qz and angular velocity NAME.wx wy wz.

Outputs are written at t = 0, at each multiple of --every, and at the end. The name of a file ends
in .part until the file is complete, also after a failed or interrupted run.

Exit codes: 0 success, 1 invalid scene or failed run, 2 wrong usage, 128 + n interrupted by signal n.)";

template <class Value>
std::vector<std::string> names_in(const std::map<std::string, Value>& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  return names;
}

std::map<std::string, IntegratorId> integrator_names() {
  std::map<std::string, IntegratorId> names;
  for (const IntegratorId id :
       {IntegratorId::explicit_euler, IntegratorId::symplectic_euler, IntegratorId::velocity_verlet,
        IntegratorId::heun, IntegratorId::runge_kutta_4}) {
    names.emplace(to_string(id), id);
  }
  return names;
}

std::map<std::string, StepControl> control_names() {
  std::map<std::string, StepControl> names;
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    names.emplace(to_string(control), control);
  }
  return names;
}

struct SimulateOptions {
  std::string scene;
  std::string scenes_folder = installed_scenes_folder();
  Level level = Level::normal;
  std::optional<Real> until;
  std::optional<Real> every;
  std::optional<Real> step;
  std::string integrator;  ///< empty: the scene's
  std::string control;     ///< empty: the scene's
  std::optional<Real> accuracy;
  std::size_t threads = 1;
  InstructionSet instructions = best_instruction_set();
  std::optional<DeviceChoice> device;  ///< absent: the scene's
  std::string output;
  std::string diagnostics;
  bool surface = false;
  bool plan = false;
  bool profile = false;
  bool hash = false;

  bool only_plan() const {
    return plan && !until && output.empty() && diagnostics.empty() && !profile && !hash;
  }
};

/// The files that a run writes; those not asked for are null.
struct Writers {
  std::unique_ptr<FrameWriter> frames;
  std::optional<DiagnosticsWriter> diagnostics;

  Status write(const Simulation& simulation, const RunTotals& totals) {
    if (frames) {
      if (Status written = frames->write(simulation); !written) return written;
    }
    return diagnostics ? diagnostics->write(simulation, totals.guard_events) : Status{};
  }

  Status finish() {
    if (frames) {
      if (Status finished = frames->finish(); !finished) return finished;
    }
    return diagnostics ? diagnostics->finish() : Status{};
  }
};

Result<Writers> create_writers(const SimulateOptions& options, const Schedule& schedule,
                               const Simulation& simulation) {
  Writers writers;
  if (!options.output.empty()) {
    auto frames = create_frame_writer(options.output, {schedule.output_count(), options.surface});
    if (!frames) return frames.errors();
    writers.frames = std::move(frames).value();
  }
  if (!options.diagnostics.empty()) {
    auto diagnostics = DiagnosticsWriter::create(options.diagnostics, simulation);
    if (!diagnostics) return diagnostics.errors();
    writers.diagnostics = std::move(diagnostics).value();
  }
  return writers;
}

Error interrupted_at(Real time) {
  std::string message = "interrupted at t = ";
  append_number(message, time);
  return {"interrupted", "", message + " s; files that are not complete end in .part"};
}

Status run_with_outputs(const SimulateOptions& options, const Schedule& schedule,
                        const InterruptWatch& interrupt, Simulation& simulation,
                        RunTotals& totals) {
  Result<Writers> writers = create_writers(options, schedule, simulation);
  if (!writers) return writers.errors();
  ProgressBar bar;
  RunHooks hooks;
  hooks.output = [&](const RunTotals& so_far) { return writers.value().write(simulation, so_far); };
  hooks.progress = [&](std::uint64_t step, Real time) -> Status {
    bar.show(step, schedule.total_steps, time);
    if (interrupt.signal() != 0) return interrupted_at(time);
    return {};
  };
  hooks.notice = [&bar](const std::string& text) {
    bar.clear();
    std::cerr << text << '\n';
  };
  if (Status done = run(simulation, schedule, hooks, totals); !done) return done;
  return writers.value().finish();
}

Real real_time_factor(const Simulation& simulation, const RunTotals& totals) {
  return totals.stepping.count() > 0 ? simulation.time() / totals.stepping.count() : 0;
}

std::string arithmetic_text(const Simulation& simulation, const RunTotals& totals) {
  const std::string set =
      std::string("instruction set: ") + to_string(simulation.instruction_set());
  if (totals.device_steps == 0) return set;
  return "device: " + std::to_string(totals.device_steps) + " steps, " +
         std::string(simulation.arithmetic()) + ", " + set;
}

void print_summary(const Simulation& simulation, const RunTotals& totals) {
  std::cerr << std::setprecision(6) << simulation.time() << " s simulated in " << totals.steps
            << " steps and " << std::setprecision(3) << totals.stepping.count()
            << " s of wall time: " << real_time_factor(simulation, totals) << " times real time, "
            << arithmetic_text(simulation, totals) << ", guard events: " << totals.guard_events;
  if (totals.wall_stops > 0) std::cerr << ", wall stops: " << totals.wall_stops;
  if (totals.unsolved_drifts > 0) {
    std::cerr << ", implicit springs not solved to the tolerance: " << totals.unsolved_drifts;
  }
  std::cerr << '\n';
}

void print_speed(const StageClock& profile, const Simulation& simulation, const RunTotals& totals) {
  print_profile(profile, totals.stepping, std::cout);
  const double ms = totals.stepping.count() * 1e3;
  std::cout << std::fixed << std::setprecision(4)
            << "ms per step: " << (totals.steps > 0 ? ms / static_cast<double>(totals.steps) : 0)
            << "\nreal-time factor: " << std::setprecision(3)
            << real_time_factor(simulation, totals) << '\n'
            << arithmetic_text(simulation, totals) << '\n';
}

void print_hash(const Simulation& simulation) {
  std::string line = "hash ";
  append_hash(line, simulation.state_hash());
  std::cout << line << ' ' << simulation.arithmetic() << '\n';
}

Result<Scene> load_scene_for(const SimulateOptions& options, Schedule& schedule) {
  Result<Scene> scene = load_scene(options.scene, options.scenes_folder, options.level);
  if (!scene) return scene;
  Numerics& numerics = scene.value().numerics;
  if (options.accuracy) {
    numerics.accuracy = options.accuracy;
    Errors errors = find_errors(scene.value());
    if (!errors.empty()) return errors;
    resolve_accuracy(scene.value());
  }
  schedule =
      make_schedule(options.step.value_or(numerics.step), options.every.value_or(numerics.tick),
                    options.until.value_or(kDefaultUntil));
  if (options.step || !options.integrator.empty() || !options.control.empty()) {
    numerics.accuracy.reset();
  }
  numerics = with_step(numerics, schedule.step);
  if (!options.integrator.empty()) numerics.integrator = integrator_names().at(options.integrator);
  if (!options.control.empty()) numerics.control = control_names().at(options.control);
  return scene;
}

int simulate(const SimulateOptions& options) {
  Schedule schedule;
  const Result<Scene> scene = load_scene_for(options, schedule);
  if (!scene) return fail(options.scene, scene.errors());
  for (const std::string& notice : schedule.notices) std::cerr << notice << '\n';
  ThreadPoolRunner runner(options.threads);
  Result<Simulation> created = Simulation::create(scene.value(), &runner, options.instructions);
  if (!created) return fail(options.scene, created.errors());
  Simulation& simulation = created.value();
  const DeviceChoice wanted = device_for(options.device, scene.value());
  const Status set = use_device(choose_device(wanted, simulation, runner), simulation);
  if (!set) return fail(options.scene, set.errors());
  if (options.plan) std::cout << simulation.plan_text();
  if (options.only_plan()) return kExitOk;
  print_warnings(options.scene, scene.value());  // of the step and integrator in use

  StageClock profile;
  if (options.profile) simulation.set_observer(&profile);
  RunTotals totals;
  const InterruptWatch interrupt;
  const Status done = run_with_outputs(options, schedule, interrupt, simulation, totals);
  if (!done) {
    const int failed = fail(options.scene, done.errors());
    return interrupt.signal() != 0 ? kExitSignal + interrupt.signal() : failed;
  }
  if (options.profile) print_speed(profile, simulation, totals);
  if (options.hash) print_hash(simulation);
  print_summary(simulation, totals);
  return kExitOk;
}

std::string check_frame_file_name(const std::string& name) {
  if (is_frame_file_name(name)) return {};
  return "'" + name + "' must end in " + kFrameEndings;
}

void add_simulate_options(CLI::App& command, SimulateOptions& options) {
  command.add_option("scene", options.scene, kSceneHelp)->required();
  command.add_option("--scenes", options.scenes_folder, "Folder of the catalogue");
  command.add_option("--until", options.until, "End of the run [s]; default: 10")
      ->check(real_in(0, kMaxUntil));
  command.add_option("--every", options.every, "Output interval [s]; default: the scene's tick")
      ->check(real_in(kMinStep, kMaxUntil));
  CLI::Option* const integrator =
      command.add_option("--integrator", options.integrator, "Default: the scene's")
          ->check(one_of(names_in(integrator_names())));
  CLI::Option* const step =
      command.add_option("--dt", options.step, "Step [s]; the longest step if steps vary")
          ->check(real_in(kMinStep, kMaxStep));
  CLI::Option* const control =
      command.add_option("--control", options.control, "Step control; default: the scene's")
          ->check(one_of(names_in(control_names())));
  command
      .add_option("--accuracy", options.accuracy,
                  "Error from which the three options above are chosen")
      ->check(real_in(kMinAccuracy, kMaxAccuracy))
      ->excludes(integrator)
      ->excludes(step)
      ->excludes(control);
  command
      .add_option("--threads", options.threads,
                  "Threads of one step; results do not depend on this number")
      ->check(CLI::Range(std::size_t{1}, kMaxThreads))
      ->capture_default_str();
  add_level_option(command, options.level);
  add_isa_option(command, options.instructions);
  add_device_option(command, options.device);
  command
      .add_option("--output", options.output,
                  std::string("File for the particles: ") + kFrameEndings)
      ->check(CLI::Validator(check_frame_file_name, "FILE"));
  command.add_flag("--surface", options.surface,
                   "Write the surfaces of liquids to the output, which ends in .glb or .abc");
  command.add_option("--diagnostics", options.diagnostics, "File for the diagnostics: .csv")
      ->check(csv_file_name());
  command.add_flag("--plan", options.plan,
                   "Print the stages of a step; do not run the scene, unless other options than "
                   "--integrator and --dt are given");
  command.add_flag("--profile", options.profile, "Print the run time of each stage");
  command.add_flag("--hash", options.hash, "Print a hash of the last state");
}

void check_together(const SimulateOptions& options) {
  namespace fs = std::filesystem;
  if (options.surface && !can_have_surfaces(options.output)) {
    throw CLI::ValidationError("--surface", "needs an --output that ends in .glb or .abc");
  }
  if (options.output.empty() || options.diagnostics.empty()) return;
  const auto place = [](const std::string& name) {
    return fs::weakly_canonical(fs::absolute(name));
  };
  if (place(options.output) == place(options.diagnostics)) {
    throw CLI::ValidationError("--diagnostics", "must not be the file of --output");
  }
}

}  // namespace

void add_simulate_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("simulate", "Run a scene without a server");
  const auto options = std::make_shared<SimulateOptions>();
  add_simulate_options(*command, *options);
  command->footer(kSimulateFooter);
  command->callback([options, &exit_code] {
    check_together(*options);
    exit_code = simulate(*options);
  });
}

}  // namespace vat
