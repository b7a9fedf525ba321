#include "tests/bench/durability/recovery.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/cli/common/command.h"
#include "server/script/server_process.h"
#include "tests/bench/report/table.h"
#include "tests/bench/soak/caller.h"
#include "tests/bench/speed/machine.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;
using RecoverySeconds = std::chrono::duration<double>;

struct RecoveryOptions {
  std::size_t particles = 28'000;
  std::size_t kills = 5;
  double warm_up = 45;
  double seconds = 60;
  std::string program = VAT_PROGRAM;
  std::string output = VAT_SOURCE_DIR "/build/bench/recovery";
};

constexpr double kMaxRecovery = 5;        // [s]
constexpr double kMaxWrittenPerDay = 20;  // [GB]
constexpr double kSecondsPerDay = 86'400;
constexpr std::size_t kParticlesPerLayer = 200;  // 10 x 20
constexpr double kRecoverySpacing = 0.04;
constexpr std::chrono::minutes kRecoveryPatience{2};

/// Returns the scene dam-break with a column and a vat that are wider.
Json wide_dam_break(std::size_t particles) {
  std::ifstream file(VAT_SOURCE_DIR "/protocol/scenes/dam-break.json");
  Json scene = Json::parse(file);
  const double width = kRecoverySpacing * static_cast<double>(std::max<std::size_t>(
                                              1, particles / kParticlesPerLayer));
  scene["vat"]["max"][1] = width;
  Json& shape = scene["bodies"][0]["shape"];
  shape["center"][1] = width / 2;
  shape["size"][1] = width;
  return scene;
}

/// Returns the bytes that a process has written to disks, without files that were removed before
/// they were written.
std::int64_t written_bytes(int process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/io");
  std::int64_t written = -1;
  std::int64_t cancelled = -1;
  std::string name;
  for (std::int64_t value = 0; file >> name >> value;) {
    if (name == "write_bytes:") written = value;
    if (name == "cancelled_write_bytes:") cancelled = value;
  }
  if (written < 0 || cancelled < 0) throw std::runtime_error("the system does not count writes");
  return written - cancelled;
}

struct Life {
  double recovery = 0;  ///< time from the start of the process to the running session [s]
  double written = 0;   ///< [bytes/s]
  double ticks = 0;     ///< per second
};

std::chrono::milliseconds to_milliseconds(RecoverySeconds time) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(time);
}

class RecoveryRun {
 public:
  explicit RecoveryRun(const RecoveryOptions& options)
      : options_(options), folder_(std::filesystem::absolute(options.output)) {
    std::filesystem::create_directories(folder_ / "scenes");
    std::filesystem::remove_all(folder_ / "data");
    if (!write_text(folder_ / "scenes/wide.json", wide_dam_break(options.particles).dump())) {
      throw std::runtime_error("cannot write in " + folder_.string());
    }
  }

  /// Starts the server, waits until its session runs, plays for the warm-up and for `time`, and
  /// kills the server.
  Life live(RecoverySeconds time) {
    Life life;
    const auto begin = steady_clock::now();
    script::ServerProcess server(options_.program,
                                 {"serve", "--port", "0", "--scenes", folder_ / "scenes", "--scene",
                                  "wide", "--data", folder_ / "data", "--log-level", "warn"});
    Caller caller(server.port(), tally_);
    const std::string session = wait_for_session(caller, begin + kRecoveryPatience);
    life.recovery = RecoverySeconds(steady_clock::now() - begin).count();
    caller.result("session.join", {{"session", session}});
    caller.result("control.reset");
    caller.result("control.play");
    caller.read_for(to_milliseconds(RecoverySeconds(options_.warm_up)));
    const std::int64_t written = written_bytes(server.process());
    const auto tick = [&] { return caller.result("session.hash").at("tick").get<double>(); };
    const double first = tick();
    const auto played = steady_clock::now();
    caller.read_for(to_milliseconds(time));
    const double passed = RecoverySeconds(steady_clock::now() - played).count();
    life.written = static_cast<double>(written_bytes(server.process()) - written) / passed;
    life.ticks = (tick() - first) / passed;
    server.kill();
    return life;
  }

 private:
  static std::string wait_for_session(Caller& caller, steady_clock::time_point deadline) {
    while (steady_clock::now() < deadline) {
      const Json sessions = caller.result("session.list").at("sessions");
      if (!sessions.empty() && sessions[0].at("state") == "running") {
        return sessions[0].at("session");
      }
      caller.read_for(std::chrono::milliseconds(10));
    }
    throw std::runtime_error("the session is not recovered");
  }

  const RecoveryOptions& options_;
  const std::filesystem::path folder_;
  Tally tally_;
};

int recover(const RecoveryOptions& options) {
  RecoveryRun run(options);
  std::vector<double> recoveries;
  double written = 0;
  double ticks = 0;
  for (std::size_t life = 0; life <= options.kills; ++life) {
    // The kills are at different times after a checkpoint.
    const double part = static_cast<double>(life) / static_cast<double>(options.kills + 1);
    const Life one = run.live(RecoverySeconds(options.seconds * (1 + part / 4)));
    std::cout << "life " << life << ": running after " << one.recovery << " s, " << one.ticks
              << " ticks/s, " << 1e-3 * one.written << " kB/s written" << std::endl;
    if (life > 0) recoveries.push_back(one.recovery);
    written = std::max(written, one.written);
    ticks += one.ticks / static_cast<double>(options.kills + 1);
  }
  std::ranges::sort(recoveries);
  const double per_day = 1e-9 * written * kSecondsPerDay;
  const bool passed = recoveries.back() <= kMaxRecovery && per_day <= kMaxWrittenPerDay;
  const Machine machine = this_machine();
  const Table table{
      {"particles", "kills", "ticks per second", "written [GB/day]", "median recovery [s]",
       "longest recovery [s]", "passed", "commit", "cpu", "cores"},
      {{std::uint64_t{options.particles}, std::uint64_t{options.kills}, ticks, per_day,
        recoveries[recoveries.size() / 2], recoveries.back(), passed, machine.commit, machine.cpu,
        std::uint64_t{machine.cores}}}};
  std::cout << to_markdown(table);
  if (const Status status = write_table(table, options.output, "recovery", "# Recovery"); !status) {
    return fail(options.output, status.errors());
  }
  return passed ? kExitOk : kExitFailed;
}

int run_recovery(const RecoveryOptions& options) {
  try {
    return recover(options);
  } catch (const std::exception& error) {
    std::cerr << "recovery: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

void add_recovery_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("recovery", "Written bytes of a large session, and its recovery");
  const auto options = std::make_shared<RecoveryOptions>();
  command
      ->add_option("--particles", options->particles, "Particles of the session, in layers of 200")
      ->check(CLI::Range(200, 1'000'000))
      ->capture_default_str();
  command->add_option("--kills", options->kills, "Number of kills")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--warm-up", options->warm_up,
                   "Time before the count of bytes, in which the server uses the saved budget")
      ->check(CLI::Range(0.0, 1e4))
      ->capture_default_str();
  command
      ->add_option("--seconds", options->seconds, "Time before each kill, in part a quarter longer")
      ->check(CLI::Range(0.1, 1e4))
      ->capture_default_str();
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the server's data")
      ->capture_default_str();
  command->footer(
      "Exit codes: 0 both bounds hold, 1 a bound is exceeded or the server failed, "
      "2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = run_recovery(*options); });
}

}  // namespace vat::bench
