#include "tests/bench/durability/durability.h"

#include <chrono>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "server/cli/common/command.h"
#include "tests/bench/fanout/served.h"
#include "tests/bench/report/quantile.h"
#include "tests/bench/report/table.h"
#include "tests/bench/soak/caller.h"
#include "tests/bench/speed/machine.h"
#include "tests/support/pool_scene.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;
using DurabilitySeconds = std::chrono::duration<double>;

struct DurabilityOptions {
  std::vector<std::size_t> sessions{1, 10, 50, 200};
  double seconds = 10;
  std::string program = VAT_PROGRAM;
  std::string output = VAT_SOURCE_DIR "/build/bench/durability";
};

constexpr std::chrono::milliseconds kBetweenCommands{50};
constexpr std::chrono::seconds kWarmUp{1};
constexpr const char* kNoJournal = "none";

/// A client with a separate session, which sends commands at a fixed rate.
class CommandClient {
 public:
  CommandClient(std::uint16_t port, Tally& tally) : caller_(port, tally) {
    const Json made = caller_.result("session.create", {{"name", "load"}, {"scene", "pool"}});
    caller_.result("session.join", {{"session", made.at("session")}});
    caller_.result("control.play");
  }

  /// Sends commands from `begin` to `end`, and notes the times of their replies.
  void run(steady_clock::time_point begin, steady_clock::time_point end) {
    for (auto next = begin; next < end; next += kBetweenCommands) {
      std::this_thread::sleep_until(next);
      const auto sent = steady_clock::now();
      caller_.result("world.apply_force", {{"body", 2}, {"force", {0, 0, 1}}, {"duration", 0.02}});
      times.push_back(DurabilitySeconds(steady_clock::now() - sent).count());
    }
  }

  std::vector<double> times;  // from command to reply [s]

 private:
  Caller caller_;
};

struct DurabilityFigures {
  std::vector<double> replies;   // [s]
  std::vector<double> lateness;  // of ticks [s]
};

class DurabilityRun {
 public:
  DurabilityRun(const DurabilityOptions& options, const std::string& mode, std::size_t sessions)
      : options_(options),
        folder_(std::filesystem::absolute(options.output)),
        log_((folder_ / "server.log").string()),
        served_(options.program, make_arguments(mode, sessions), log_) {
    for (std::size_t i = 0; i < sessions; ++i) {
      clients_.push_back(std::make_unique<CommandClient>(served_.port(), tally_));
    }
  }

  DurabilityFigures measure() {
    send_for(kWarmUp);
    for (const auto& client : clients_) client->times.clear();
    const std::size_t begin = served_.log_size();
    send_for(DurabilitySeconds(options_.seconds));
    DurabilityFigures figures;
    for (const TickTimes& tick : served_.ticks_since(begin)) {
      figures.lateness.push_back(tick.lateness);
    }
    for (const auto& client : clients_) {
      figures.replies.insert(figures.replies.end(), client->times.begin(), client->times.end());
    }
    return figures;
  }

 private:
  std::vector<std::string> make_arguments(const std::string& mode, std::size_t sessions) const {
    std::filesystem::create_directories(folder_ / "scenes");
    std::filesystem::remove_all(folder_ / "data");
    if (!write_text(folder_ / "scenes/pool.json", test::kPoolScene)) {
      throw std::runtime_error("cannot write in " + folder_.string());
    }
    const std::string limit = std::to_string(2 * sessions + 10);
    std::vector<std::string> words{"--scenes", folder_ / "scenes", "--scene",
                                   "pool",     "--log-level",      "debug"};
    for (const char* name :
         {"--max-sessions", "--max-sessions-per-address", "--max-connections-per-address"}) {
      words.insert(words.end(), {name, limit});
    }
    for (const char* rate : {"--max-controls-per-second", "--max-scenes-per-second"}) {
      words.insert(words.end(), {rate, "1e5"});
    }
    if (mode == kNoJournal) {
      words.insert(words.end(), {"--data", "none"});
    } else {
      words.insert(words.end(), {"--data", folder_ / "data", "--durability", mode});
    }
    return words;
  }

  void send_for(DurabilitySeconds time) {
    const auto length = std::chrono::duration_cast<steady_clock::duration>(time);
    const auto begin = steady_clock::now();
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < clients_.size(); ++i) {
      const auto phase = kBetweenCommands * i / clients_.size();
      threads.emplace_back([this, i, first = begin + phase, end = begin + length] {
        try {
          clients_[i]->run(first, end);
        } catch (const std::exception& error) {
          tally_.add_fault(error.what());
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    const std::vector<std::string> faults = tally_.faults();
    if (!faults.empty()) throw std::runtime_error(faults.front());
  }

  const DurabilityOptions& options_;
  const std::filesystem::path folder_;
  const std::string log_;
  Tally tally_;
  Served served_;
  std::vector<std::unique_ptr<CommandClient>> clients_;
};

Table measure_durability(const DurabilityOptions& options) {
  const Machine machine = this_machine();
  Table table{{"sessions", "durability", "commands", "median reply [ms]", "99 % reply [ms]",
               "median lateness [ms]", "99 % lateness [ms]", "commit", "cpu", "cores"},
              {}};
  for (const std::size_t sessions : options.sessions) {
    for (const char* mode : {kNoJournal, "process", "power"}) {
      const DurabilityFigures figures = DurabilityRun(options, mode, sessions).measure();
      if (figures.replies.empty() || figures.lateness.empty()) {
        throw std::runtime_error("nothing was measured");
      }
      table.rows.push_back(
          {std::uint64_t{sessions}, mode, std::uint64_t{figures.replies.size()},
           1e3 * quantile(figures.replies, 0.5), 1e3 * quantile(figures.replies, 0.99),
           1e3 * quantile(figures.lateness, 0.5), 1e3 * quantile(figures.lateness, 0.99),
           machine.commit, machine.cpu, std::uint64_t{machine.cores}});
      std::cout << sessions << " sessions, durability " << mode << " measured" << std::endl;
    }
  }
  return table;
}

int durability(const DurabilityOptions& options) {
  try {
    const Table table = measure_durability(options);
    std::cout << to_markdown(table);
    const Status written = write_table(table, options.output, "durability", "# Durability");
    return written ? kExitOk : fail(options.output, written.errors());
  } catch (const std::exception& error) {
    std::cerr << "durability: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

void add_durability_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "durability", "Time of replies and ticks with commands that a journal stores");
  const auto options = std::make_shared<DurabilityOptions>();
  command->add_option("--sessions", options->sessions, "Numbers of sessions")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Length of each measurement")
      ->check(CLI::Range(0.1, 1e4))
      ->capture_default_str();
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the server's data")
      ->capture_default_str();
  command->footer("Exit codes: 0 measured, 1 the server failed, 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = durability(*options); });
}

}  // namespace vat::bench
