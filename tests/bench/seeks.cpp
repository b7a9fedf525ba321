#include "tests/bench/seeks.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "server/script/server_process.h"
#include "tests/bench/report/table.h"
#include "tests/bench/soak/caller.h"
#include "tests/bench/speed/machine.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

struct SeeksOptions {
  std::string scene = "sliding-vat-liquid";
  std::uint64_t ticks = 15'000;
  std::size_t seeks = 150;
  std::uint32_t seed = 1;
  std::string program = VAT_PROGRAM;
  std::string output = VAT_SOURCE_DIR "/build/bench/seeks";
};

constexpr std::uint64_t kMost = 100;   // ticks per call, which must be answered within a minute
constexpr std::uint64_t kTurn = 1000;  // ticks between two commands
constexpr double kAsked = 0.2;         // [s]

struct SeekSeries {
  std::uint64_t checkpoints = 0;
  std::vector<double> times;  // [s]
};

class Seeks {
 public:
  explicit Seeks(const SeeksOptions& options)
      : options_(options), server_(start(options)), caller_(server_.port(), tally_) {}

  SeekSeries run() {
    const std::string session = record();
    const Json opened = caller_.result("replay.open", {{"session", session}});
    caller_.result("session.join", {{"session", opened.at("session")}});
    begin_ = opened.at("begin");
    end_ = opened.at("end");
    return measure();
  }

 private:
  static script::ServerProcess start(const SeeksOptions& options) {
    const std::filesystem::path folder = std::filesystem::absolute(options.output);
    std::filesystem::remove_all(folder / "data");
    std::filesystem::create_directories(folder);
    return {
        options.program,
        {"serve", "--port", "0", "--scenes", VAT_DEFAULT_SCENES_DIR, "--scene", options.scene,
         "--data", folder / "data", "--max-controls-per-second", "1e6", "--log-level", "error"}};
  }

  /// Records a session with occasional commands. Returns its id.
  std::string record() {
    const Json session = caller_.result("session.list").at("sessions").at(0).at("session");
    caller_.result("session.join", {{"session", session}});
    caller_.result("control.pause");
    caller_.result("control.reset");
    for (std::uint64_t done = 0; done < options_.ticks; done += kMost) {
      if (done % kTurn == 0) {
        std::cout << done << " of " << options_.ticks << " ticks are recorded" << std::endl;
        const double sideways = done / kTurn % 2 == 0 ? 0 : 0.3;
        caller_.result("world.set_gravity", {{"gravity", {sideways, 0, -9.81}}});
      }
      caller_.result("control.step", {{"ticks", std::min(kMost, options_.ticks - done)}});
    }
    return session;
  }

  SeekSeries measure() {
    std::mt19937_64 random(options_.seed);
    SeekSeries series{caller_.result("replay.info").at("checkpoints").size(), {}};
    while (series.times.size() < options_.seeks) {
      const std::uint64_t position = begin_ + random() % (end_ - begin_ + 1);
      const auto begin = steady_clock::now();
      const Json there = caller_.result("replay.seek", {{"position", position}});
      series.times.push_back(Seconds(steady_clock::now() - begin).count());
      if (there.at("position") != position) {
        throw std::runtime_error("it went to " + there.dump() + " in place of " +
                                 std::to_string(position));
      }
    }
    std::ranges::sort(series.times);
    return series;
  }

  const SeeksOptions options_;
  Tally tally_;
  script::ServerProcess server_;
  Caller caller_;
  std::uint64_t begin_ = 0;
  std::uint64_t end_ = 0;
};

Table to_seek_table(const SeekSeries& series, const SeeksOptions& options) {
  const Machine machine = this_machine();
  const auto& [checkpoints, times] = series;
  const auto part = [&, &sorted = times](double of) {
    return 1e3 * sorted[static_cast<std::size_t>(of * static_cast<double>(sorted.size() - 1))];
  };
  const auto within = std::ranges::upper_bound(times, kAsked) - times.begin();
  return {{"scene", "ticks", "checkpoints", "seeks", "median [ms]", "99 % [ms]", "longest [ms]",
           "asked [ms]", "within", "commit", "cpu", "cores"},
          {{options.scene, options.ticks, checkpoints, std::uint64_t{times.size()}, part(0.5),
            part(0.99), part(1), 1e3 * kAsked, static_cast<std::uint64_t>(within), machine.commit,
            machine.cpu, std::uint64_t{machine.cores}}}};
}

int seeks(const SeeksOptions& options) {
  try {
    const Table table = to_seek_table(Seeks(options).run(), options);
    std::cout << to_markdown(table);
    if (const Status written = write_table(table, options.output, "seeks", "# Seeks"); !written) {
      return fail(options.output, written.errors());
    }
  } catch (const std::exception& error) {
    std::cerr << "seeks: " << error.what() << '\n';
    return kExitFailed;
  }
  return kExitOk;
}

}  // namespace

void add_seeks_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("seeks", "Time of seeks in a recording, in a running server");
  const auto options = std::make_shared<SeeksOptions>();
  command->add_option("--scene", options->scene, "What is recorded")->capture_default_str();
  const auto add = [&](const char* name, auto& target, const char* help, double min, double max) {
    command->add_option(name, target, help)->check(CLI::Range(min, max))->capture_default_str();
  };
  add("--ticks", options->ticks, "Length of the recording", 1, 1e6);
  add("--seeks", options->seeks, "Number of seeks", 1, 1e6);
  add("--seed", options->seed, "Of where", 0, 1e6);
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the server's data")
      ->capture_default_str();
  command->footer("Exit codes: 0 measured, 1 the server failed, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = seeks(*options); });
}

}  // namespace vat::bench
