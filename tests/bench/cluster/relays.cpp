#include "tests/bench/cluster/relays.h"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/cli/common/command.h"
#include "server/cli/serve/open_files.h"
#include "tests/bench/cluster/relayed_service.h"
#include "tests/bench/fanout/case.h"
#include "tests/bench/fanout/fanout.h"
#include "tests/bench/fanout/load.h"
#include "tests/bench/report/table.h"
#include "tests/bench/speed/machine.h"

namespace vat::bench {
namespace {

struct RelaysOptions {
  std::vector<std::size_t> viewers{2, 100, 1000};
  double max_error = 0;
  double seconds = 10;
  std::string program = VAT_PROGRAM;
  std::string output = VAT_SOURCE_DIR "/build/bench/relays";
};

constexpr std::size_t kOpenFiles = 64;  // besides sockets
constexpr auto kSettlingTime = std::chrono::seconds(3);

struct RelaysRow {
  std::size_t viewers = 0;
  FanoutResult seen;
  std::array<double, 3> cores{};  ///< owner, relays, NATS
};

RelaysRow measure_relays(const RelaysOptions& options, const std::filesystem::path& folder,
                         const std::string& scene, std::size_t viewers) {
  std::filesystem::remove_all(folder);
  const RelayedService service(options.program, folder, scene, viewers);
  std::vector<std::unique_ptr<LoadSettings>> settings;
  std::vector<std::unique_ptr<LoadProcess>> load;
  for (std::size_t relay = 0; relay < RelayedService::kRelays; ++relay) {
    settings.push_back(std::make_unique<LoadSettings>(
        LoadSettings{service.relay_port(relay), options.max_error, 0, "s1"}));
    ViewerCounts counts{};
    counts[static_cast<std::size_t>(ViewerKind::plain)] = viewers / RelayedService::kRelays;
    load.push_back(
        std::make_unique<LoadProcess>(*settings.back(), counts, static_cast<std::uint32_t>(relay)));
  }
  for (const auto& process : load) process->wait_ready();
  std::this_thread::sleep_for(kSettlingTime);
  const auto begin = LoadClock::now();
  for (const auto& process : load) process->begin();
  const auto before = service.processor_seconds();
  std::this_thread::sleep_for(std::chrono::duration<double>(options.seconds));
  const auto after = service.processor_seconds();
  const double time = std::chrono::duration<double>(LoadClock::now() - begin).count();
  LoadSightings seen;
  for (const auto& process : load) append(seen, process->end());
  RelaysRow row{viewers, {}, {}};
  const double seconds = std::chrono::duration<double>(LoadClock::now() - begin).count();
  row.seen = summarise(seen[static_cast<std::size_t>(ViewerKind::plain)], viewers, seconds);
  for (std::size_t part = 0; part < row.cores.size(); ++part) {
    row.cores[part] = (after[part] - before[part]) / time;
  }
  return row;
}

Table to_relays_table(const std::vector<RelaysRow>& rows) {
  const Machine machine = this_machine();
  Table table{{"viewers", "frames per second", "frame bytes", "age median [ms]", "age 99 % [ms]",
               "first frame 99 % [ms]", "closed", "owner [cores]", "relays [cores]", "NATS [cores]",
               "commit", "cpu", "cores of the machine"},
              {}};
  for (const RelaysRow& row : rows) {
    table.rows.push_back({std::uint64_t{row.viewers}, row.seen.frames_per_second,
                          row.seen.frame_bytes, 1e3 * row.seen.age_median, 1e3 * row.seen.age_99,
                          1e3 * row.seen.first_frame_99, std::uint64_t{row.seen.closed},
                          row.cores[0], row.cores[1], row.cores[2], machine.commit, machine.cpu,
                          std::uint64_t{machine.cores}});
  }
  return table;
}

int run_relays(const RelaysOptions& options) {
  const std::filesystem::path folder = std::filesystem::absolute(options.output);
  std::filesystem::create_directories(folder);
  const std::string scene = folder / "scene.json";
  if (const Status written = write_text(scene, kFanoutScene); !written) {
    return fail(scene, written.errors());
  }
  const auto rows = measure_each<RelaysRow>("relays", options.viewers, [&](std::size_t viewers) {
    if (raise_open_files(viewers + kOpenFiles) < viewers + kOpenFiles) {
      throw std::runtime_error("the system allows too few open files (ulimit -n)");
    }
    return measure_relays(options, folder / "data", scene, viewers);
  });
  if (!rows) return kExitFailed;
  const Table table = to_relays_table(*rows);
  std::cout << '\n' << to_markdown(table);
  const Status written =
      write_table(table, options.output, "relays", "# Viewers through two relays");
  return written ? kExitOk : fail(options.output, written.errors());
}

}  // namespace

void add_relays_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("relays", "Many viewers of one session through two relays of a cluster");
  const auto options = std::make_shared<RelaysOptions>();
  command->add_option("--viewers", options->viewers, "Numbers of viewers, at both relays together")
      ->check(CLI::Range(2, 20'000))
      ->delimiter(',')
      ->capture_default_str();
  command
      ->add_option("--max-error", options->max_error,
                   "Maximum position error [m] that viewers request; 0: the finest grid")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Measured time [s]")
      ->check(CLI::Range(1, 3600))
      ->capture_default_str();
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the nodes' data")
      ->capture_default_str();
  command->footer("Exit codes: 0 measured, 1 the servers or the viewers failed, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = run_relays(*options); });
}

}  // namespace vat::bench
