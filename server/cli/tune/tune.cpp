#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include "core/limits.h"
#include "core/threads/thread_pool.h"
#include "protocol/files/output_file.h"
#include "protocol/scene/scene_json.h"
#include "protocol/tune/scene_edit.h"
#include "protocol/tune/tuning.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"
#include "server/cli/common/option_checks.h"
#include "server/cli/common/scene_argument.h"
#include "server/cli/simulate/simulate_interrupt.h"
#include "server/cli/tune/tune_progress.h"
#include "server/cli/tune/tune_report.h"
#include "server/people/governor_points.h"

namespace vat {
namespace {

namespace fs = std::filesystem;

constexpr Real kLongestTunedRun = 1000;  // [s]
constexpr Real kLeastWantedError = 1e-9;
constexpr Real kGreatestWantedError = 1;
constexpr int kMostRepetitions = 99;
constexpr std::size_t kMostTuneThreads = 256;

constexpr const char* kTuneFooter =
    R"(Runs the scene with the solvers, integrators, steps and tolerances that it supports, and prints
those with the least time for their error. Errors are relative to a reference run with shorter
steps; protocol/tune/TUNE.md defines them. Columns: error, computing time per simulated second, the
same in the slowest part of the run, steps, iterations per step. A star marks the present numerics.

With one thread, the time is that of the processor. With more threads, it is the elapsed time.
An interrupted run prints the candidates that are completed, and writes nothing.

Exit codes: 0 success, 1 invalid scene or no such choice, 2 wrong usage, 128 + n interrupted by
signal n.)";

struct TuneOptions {
  std::string scene;
  std::string scenes_folder = installed_scenes_folder();
  Real until = 1;
  std::optional<Real> error;
  bool real_time = false;
  std::string output;
  std::string front;
  bool exhaustive = false;
  int repetitions = 3;
  std::size_t threads = 1;
};

double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  constexpr double kNano = 1e-9;
  return static_cast<double>(time.tv_sec) + kNano * static_cast<double>(time.tv_nsec);
}

double elapsed_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Returns the text of the scene with these numerics, which is valid as the file `output`.
Result<std::string> tuned_text(const TuneOptions& options, const tune::Candidate& candidate,
                               bool has_liquid) {
  const fs::path source = scene_file(options.scene, options.scenes_folder);
  const auto folder_of = [](const fs::path& file) {
    return file.has_parent_path() ? file.parent_path().string() : std::string(".");
  };
  const Result<std::string> text =
      meshes_relative_to(folder_of(source))(source.filename().string());
  if (!text) return text.errors();
  Result<std::string> tuned = tune::with_numerics(text.value(), candidate, has_liquid);
  if (!tuned) return tuned;
  const MeshSource meshes = meshes_in_folder(folder_of(options.output));
  if (const Result<Scene> read = read_scene_text(tuned.value(), meshes); !read) {
    return read.errors();
  }
  return tuned;
}

Status write_choice(const TuneOptions& options, const tune::Candidate& candidate, bool has_liquid) {
  const Result<std::string> text = tuned_text(options, candidate, has_liquid);
  if (!text) return text.errors();
  return write_output_file(options.output, text.value());
}

/// Returns the choice and the cheaper points among which a session's governor can choose.
std::vector<GovernorPoint> governor_points(const Scene& scene, const tune::Tuning& tuning,
                                           const TuneReport& report, const tune::Point& choice) {
  const std::vector<tune::Candidate>& candidates = tuning.set().candidates;
  std::vector<tune::Point> suitable;
  for (const tune::Point& point : report.points) {
    const tune::Candidate& chosen = candidates[choice.candidate];
    if (tune::can_change(chosen, candidates[point.candidate], scene)) suitable.push_back(point);
  }
  std::vector<GovernorPoint> points;
  for (const tune::Point& point : tune::cheaper_points(suitable, choice, kMaxGovernorPoints)) {
    const bool has_liquid = tuning.set().has_liquid;
    points.push_back(
        {tune::change_to(candidates[point.candidate], has_liquid), point.error, point.seconds});
  }
  return points;
}

/// Writes the parameters of session.configure.
Status write_front(const TuneOptions& options, std::span<const GovernorPoint> points) {
  if (points.size() < 2) {
    return Error{"not_reached", "",
                 "no completed candidate of the same solver is faster than the choice"};
  }
  const Json params{{"governor", write_governor_points(points)}};
  constexpr int kIndent = 2;
  return write_output_file(options.front, params.dump(kIndent) + '\n');
}

Result<tune::Point> choose_point(const TuneOptions& options, const tune::Tuning& tuning,
                                 const TuneReport& report) {
  if (options.error) {
    return tune::choose_for_error(report.points, *options.error, tuning.measure().floor());
  }
  return tune::choose_for_real_time(report.points);
}

void print_report(const tune::Tuning& tuning, const TuneReport& report) {
  const tune::Parts& parts = tuning.parts();
  const std::size_t horizon = tuning.measure().horizon();
  std::cout << report.counts() << '\n'
            << "error over " << parts.duration * static_cast<Real>(horizon) / parts.count
            << " s of " << parts.duration << " s; noise floor: " << tuning.measure().floor()
            << "\n\n"
            << report.table() << '\n'
            << report.plot();
}

int finish_tuning(const Scene& scene, const TuneOptions& options, const tune::Tuning& tuning,
                  const TuneReport& report) {
  if (!options.error && !options.real_time) return kExitOk;
  const Result<tune::Point> choice = choose_point(options, tuning, report);
  if (!choice) return fail(options.scene, choice.errors());
  const tune::CandidateSet& set = tuning.set();
  const tune::Candidate& candidate = set.candidates[choice.value().candidate];
  std::cout << "\nchosen: " << describe(candidate, set.has_liquid) << '\n';
  if (!options.output.empty()) {
    if (const Status written = write_choice(options, candidate, set.has_liquid); !written) {
      return fail(options.output, written.errors());
    }
    std::cout << "written to " << options.output << '\n';
  }
  if (options.front.empty()) return kExitOk;
  const auto points = governor_points(scene, tuning, report, choice.value());
  if (const Status written = write_front(options, points); !written) {
    return fail(options.front, written.errors());
  }
  std::cout << points.size() << " points for the governor written to " << options.front << '\n';
  return kExitOk;
}

int tune_scene(const TuneOptions& options) {
  const Result<Scene> scene = load_scene(options.scene, options.scenes_folder);
  if (!scene) return fail(options.scene, scene.errors());
  if (!options.output.empty()) {  // fails before the runs
    const Result<std::string> text = tuned_text(options, tune::candidate_of(scene.value()), false);
    if (!text) return fail(options.output, text.errors());
  }
  ThreadPoolRunner runner(options.threads);
  const InterruptWatch interrupt;
  std::optional<TuneProgress> bar(std::in_place);
  tune::TuneSettings settings;
  settings.until = options.until;
  settings.repetitions = options.repetitions;
  if (options.exhaustive) settings.drops = tune::DropRule::never;
  settings.runner = &runner;
  settings.clock = options.threads > 1 ? elapsed_seconds : thread_seconds;
  settings.stop = [&interrupt] { return interrupt.signal() != 0; };
  settings.show = [&bar](const std::string& stage, const tune::Progress& progress) {
    bar->show(stage, progress);
  };
  std::cout << "measuring runs of " << options.until << " s\n" << std::flush;
  const Result<tune::Tuning> tuning = tune::Tuning::create(scene.value(), settings);
  const int signal_code = kExitSignal + interrupt.signal();
  if (!tuning) {
    bar.reset();
    const int failed = fail(options.scene, tuning.errors());
    return interrupt.signal() != 0 ? signal_code : failed;
  }
  TuneReport report{tuning.value().set(), tuning.value().search(), {}, {}};
  report.points = tuning.value().points(report.outcomes);
  report.front = tune::pareto_front(report.points);
  bar.reset();
  print_report(tuning.value(), report);
  if (interrupt.signal() != 0) {
    fail(options.scene, {{"interrupted", "", "interrupted; the front is incomplete"}});
    return kExitSignal + interrupt.signal();
  }
  return finish_tuning(scene.value(), options, tuning.value(), report);
}

std::string check_tuned_name(const std::string& name) {
  const bool good = fs::path(name).extension() == ".json";
  return good ? std::string() : "'" + name + "' must end in .json";
}

}  // namespace

void add_tune_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("tune", "Measure the numerics of a scene, and choose");
  const auto options = std::make_shared<TuneOptions>();
  command->add_option("scene", options->scene, kSceneHelp)->required();
  command->add_option("--scenes", options->scenes_folder, "Folder of the catalogue");
  command->add_option("--until", options->until, "Duration of the measured runs [s]")
      ->check(real_in(kMinStep, kLongestTunedRun))
      ->capture_default_str();
  CLI::Option* const error =
      command
          ->add_option("--error", options->error, "Choose the least time with at most this error")
          ->check(real_in(kLeastWantedError, kGreatestWantedError));
  command
      ->add_flag("--real-time", options->real_time,
                 "Choose the least error in real time, with 20 % of the time free")
      ->excludes(error);
  command
      ->add_option("--write", options->output,
                   "Scene file for the choice; it may be that of the scene")
      ->check(CLI::Validator(check_tuned_name, "FILE"));
  command
      ->add_option("--front", options->front,
                   "File for the choice and the cheaper points of a session's governor")
      ->check(CLI::Validator(check_tuned_name, "FILE"));
  command->add_flag("--exhaustive", options->exhaustive, "Drop no candidate early");
  command->add_option("--repetitions", options->repetitions, "Timed runs of the best candidates")
      ->check(CLI::Range(1, kMostRepetitions))
      ->capture_default_str();
  command->add_option("--threads", options->threads, "Threads of one step")
      ->check(CLI::Range(std::size_t{1}, kMostTuneThreads))
      ->capture_default_str();
  command->footer(kTuneFooter);
  command->callback([options, &exit_code] {
    const bool chooses = options->error || options->real_time;
    if (!options->output.empty() && !chooses) {
      throw CLI::RequiredError("--write needs --error or --real-time, which");
    }
    if (!options->front.empty() && !chooses) {
      throw CLI::RequiredError("--front needs --error or --real-time, which");
    }
    exit_code = tune_scene(*options);
  });
}

}  // namespace vat
