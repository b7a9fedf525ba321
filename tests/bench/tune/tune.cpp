#include "tests/bench/tune/tune.h"

#include <ctime>
#include <iostream>
#include <memory>

#include "core/limits.h"
#include "protocol/scene/scene_json.h"
#include "server/cli/common/command.h"
#include "server/cli/common/option_checks.h"
#include "server/cli/common/scene_argument.h"
#include "tests/bench/options.h"
#include "tests/bench/tune/tune_case.h"

namespace vat::bench {
namespace {

struct TuneBenchOptions : Options {
  Real until = 1;  ///< duration of the runs [s]
};

double processor_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Returns the processor time of `work`.
template <class Work>
double time_of_work(Work&& work) {
  const double begin = processor_seconds();
  work();
  return processor_seconds() - begin;
}

Result<TuneResultRow> compare_scene(const std::string& name, const TuneBenchOptions& options) {
  const Result<Scene> scene = load_scene(name, VAT_DEFAULT_SCENES_DIR);
  if (!scene) return scene.errors();
  tune::TuneSettings settings;
  settings.until = options.until;
  settings.clock = processor_seconds;
  std::optional<Result<tune::Tuning>> created;
  const double references =
      time_of_work([&] { created.emplace(tune::Tuning::create(scene.value(), settings)); });
  if (!*created) return created->errors();
  tune::Tuning& tuning = created->value();
  std::vector<tune::Outcome> searched;
  std::vector<tune::Outcome> all;
  const double search = time_of_work([&] { searched = tuning.search(); });
  tuning.set_drops(tune::DropRule::proven);
  const double exhaustive = time_of_work([&] { all = tuning.search(); });
  TuneResultRow row = compare_searches(name, tuning, searched, all);
  row.search_seconds = references + search;
  row.exhaustive_seconds = references + exhaustive;
  return row;
}

int compare_catalogue(const TuneBenchOptions& options) {
  const Result<std::vector<std::string>> names = catalogue_names(VAT_DEFAULT_SCENES_DIR);
  if (!names) return fail("tune", names.errors());
  if (options.list) {
    print_names(names.value());
    return kExitOk;
  }
  const Result<std::vector<std::size_t>> chosen = choose(options.cases, names.value());
  if (!chosen) return fail("tune", chosen.errors());
  std::vector<TuneResultRow> rows;
  for (const std::size_t index : chosen.value()) {
    if (options.quick && index > 0 && options.cases.empty()) break;
    const Result<TuneResultRow> row = compare_scene(names.value()[index], options);
    if (!row) return fail(names.value()[index], row.errors());
    std::cout << to_markdown(tune_table({row.value()})) << std::endl;
    rows.push_back(row.value());
  }
  std::cout << to_markdown(tune_table(rows));
  const Status written = write_table(tune_table(rows), options.output, "tune",
                                     "# Choices of vat tune, compared with an exhaustive search");
  return written ? kExitOk : fail(options.output, written.errors());
}

}  // namespace

void add_tune_bench_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "tune", "Choices of vat tune for the catalogue, compared with an exhaustive search");
  const auto options = std::make_shared<TuneBenchOptions>();
  add_case_options(*command, *options);
  command->add_option("--until", options->until, "Duration of the runs [s]")
      ->check(real_in(kMinStep, 100))
      ->capture_default_str();
  command->footer("Exit codes: 0 measured, 1 a scene or a file failed, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = compare_catalogue(*options); });
}

}  // namespace vat::bench
