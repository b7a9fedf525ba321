#include "tests/bench/faults/faults.h"

#include <exception>
#include <iostream>
#include <memory>

#include "server/cli/common/command.h"
#include "server/cli/serve/open_files.h"
#include "tests/bench/faults/fault_soak.h"

namespace vat::bench {
namespace {

constexpr std::size_t kFaultsOtherFiles = 128;

int faults(const FaultOptions& options) {
  const std::size_t files = options.clients + kFaultsOtherFiles;
  if (raise_open_files(files) < files) {
    std::cerr << "faults: the system does not allow " << files << " open files (ulimit -n)\n";
    return kExitFailed;
  }
  try {
    return run_fault_soak(options) ? kExitOk : kExitFailed;
  } catch (const std::exception& error) {
    std::cerr << "faults: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

void add_faults_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "faults", "Load test with hostile clients, kills, and faults of disk, clock and memory");
  const auto options = std::make_shared<FaultOptions>();
  const auto add = [&](const char* name, auto& target, const char* help, double min, double max) {
    command->add_option(name, target, help)->check(CLI::Range(min, max))->capture_default_str();
  };
  add("--seconds", options->seconds, "Duration of the load", 1, 1e6);
  add("--kill-every", options->kill_every, "Time between two kills [s]", 1, 1e6);
  add("--sessions", options->sessions, "Sessions", 1, 1000);
  add("--clients", options->clients, "Clients; half of them have invalid tokens", 14, 10'000);
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the server's data")
      ->capture_default_str();
  command->footer(
      "Exit codes: 0 all bounds hold, 1 a bound is exceeded or the test cannot run, 2 wrong "
      "usage.");
  command->callback([options, &exit_code] { exit_code = faults(*options); });
}

}  // namespace vat::bench
