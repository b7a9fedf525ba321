#include "tests/bench/soak/soak.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "server/cli/common/command.h"
#include "server/cli/serve/open_files.h"
#include "server/operations/heap.h"
#include "server/script/server_process.h"
#include "tests/bench/report/table.h"
#include "tests/bench/soak/caller.h"
#include "tests/bench/soak/clients.h"
#include "tests/bench/soak/process_figures.h"
#include "tests/bench/soak/trend.h"
#include "tests/support/pool_scene.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;
using SoakSeconds = std::chrono::duration<double>;

struct SoakOptions {
  double seconds = 600;
  std::size_t sessions = 20;
  std::size_t clients = 100;
  std::uint32_t seed = 1;
  std::string program = VAT_PROGRAM;
  std::string output = "build/bench/soak";
};

/// A shorter run has not warmed up by its first rest, and has only one rest at its end.
constexpr double kMinForRests = 300;  // [s]
constexpr std::size_t kRests = 6;
/// By then the server has released unused memory.
constexpr std::chrono::milliseconds kRest = MemoryReturn::kInterval + std::chrono::seconds(2);
constexpr double kMaxHeapGrowth = 0.05;
/// The location of used blocks in the heap is random, and so is the number of free pages.
constexpr double kMaxResidentGrowth = 0.125;
constexpr std::size_t kSamples = 600;
constexpr std::chrono::seconds kReturn{30};  // for connections of clients that disconnected
constexpr std::size_t kSoakOtherFiles = 64;

class Soak {
 public:
  explicit Soak(const SoakOptions& options) : options_(options), server_(start(options)) {
    Caller maker(server_.port(), tally_);
    sessions_.push_back(maker.result("session.list")["sessions"][0]["session"]);
    while (sessions_.size() < options.sessions) {
      const Json made = maker.result("session.create", {{"name", "one"}, {"scene", "pool"}});
      sessions_.push_back(made.at("session"));
    }
    for (const std::string& session : sessions_) {  // everything that opens once is open afterwards
      maker.result("session.join", {{"session", session}});
      maker.result("control.play");
    }
  }

  /// Runs the soak and prints its failures. Returns whether there were none.
  bool run() {
    std::this_thread::sleep_for(
        std::chrono::seconds(2));  // the creator's connection has ended by then
    const ProcessFigures before = process_figures(server_.process());
    const std::size_t rests = options_.seconds < kMinForRests ? 1 : kRests;
    while (resting_.size() < rests && faults_ == 0) {
      let_clients_come(options_.seconds / static_cast<double>(rests));
      for (const std::string& fault : tally_.faults()) fail(fault);
      rest(before, rests > 1);
    }
    if (rests == kRests && faults_ == 0) look_at_memory();
    ask_every_session();
    if (const int status = server_.stop(); status != 0) {
      fail("the server ended with " + std::to_string(status));
    }
    write(before);
    return faults_ == 0;
  }

 private:
  static script::ServerProcess start(const SoakOptions& options) {
    std::filesystem::create_directories(std::filesystem::path(options.output) / "scenes");
    const std::filesystem::path folder = std::filesystem::absolute(options.output);
    std::filesystem::remove_all(folder / "data");
    if (!write_text(folder / "scenes/pool.json", test::kPoolScene)) {
      throw std::runtime_error("cannot write in " + folder.string());
    }
    const std::string most = std::to_string(2 * options.sessions + options.clients);
    return {options.program,
            {"serve", "--port", "0", "--scenes", folder / "scenes", "--scene", "pool", "--data",
             folder / "data", "--max-sessions", most, "--max-sessions-per-address", most,
             "--max-connections-per-address", std::to_string(2 * options.clients + 10),
             "--resume-seconds", "2", "--log-level", "error"}};
  }

  void fail(const std::string& what) {
    ++faults_;
    std::cout << "FAULT: " << what << std::endl;
  }
  void expect_alike(const char* what, std::size_t before, std::size_t after) {
    if (before == after) return;
    fail(std::string(what) + ": " + std::to_string(before) + " before, " + std::to_string(after) +
         " after all have left");
  }

  void let_clients_come(double seconds) {
    std::atomic<bool> stop = false;
    std::vector<std::thread> clients;
    for (std::size_t i = 0; i < options_.clients; ++i) {
      const SoakPlace place{server_.port(), sessions_[i % sessions_.size()]};
      // Every session gets each behaviour in turn, for any number of sessions.
      const auto manner = static_cast<Manner>((i + i / sessions_.size()) % kManners);
      const std::size_t seed = (options_.seed * kRests + resting_.size()) * options_.clients + i;
      clients.emplace_back([=, this, &stop] {
        run_soak_client(manner, place, static_cast<std::uint32_t>(seed), stop, tally_);
      });
    }
    const auto begin = steady_clock::now();
    const auto end = begin + SoakSeconds(seconds);
    auto next = begin;
    while (steady_clock::now() < end && server_.is_running() && tally_.faults().empty()) {
      resident_.push_back(process_figures(server_.process()).resident);
      next += std::chrono::duration_cast<steady_clock::duration>(SoakSeconds(options_.seconds) /
                                                                 kSamples);
      std::this_thread::sleep_until(next);
    }
    if (!server_.is_running()) fail("the server has ended");
    stop = true;
    for (std::thread& client : clients) client.join();
    seconds_ += SoakSeconds(steady_clock::now() - begin).count();
  }

  /// Checks that the server has released its resources after all clients have left.
  void rest(const ProcessFigures& before, bool settles) {
    after_ = wait_for_return(before);
    expect_alike("open files", before.files, after_.files);
    expect_alike("threads", before.threads, after_.threads);
    if (settles) std::this_thread::sleep_for(kRest);
    resting_.push_back(process_figures(server_.process()).resident);
    resting_heap_.push_back(heap_in_use());
  }

  double heap_in_use() {
    const std::string metrics = fetch(server_.port(), "/metrics")["text"];
    constexpr std::string_view kName = "\nvat_heap_bytes ";
    const std::size_t at = metrics.find(kName);
    if (at == std::string::npos) throw std::runtime_error("no vat_heap_bytes in /metrics");
    return std::stod(metrics.substr(at + kName.size()));
  }

  void look_at_memory() {
    if (!is_flat(resting_heap_, kMaxHeapGrowth)) fail("the heap in use at rest has grown");
    if (!is_flat(resting_, kMaxResidentGrowth)) fail("what is resident at rest has grown");
  }

  /// Returns the resources of the server after it has noticed all disconnections.
  ProcessFigures wait_for_return(const ProcessFigures& before) {
    const auto deadline = steady_clock::now() + kReturn;
    ProcessFigures now = process_figures(server_.process());
    while ((now.files != before.files || now.threads != before.threads) &&
           steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      now = process_figures(server_.process());
    }
    return now;
  }

  void ask_every_session() {
    Caller caller(server_.port(), tally_);
    const std::size_t count = caller.result("session.list").at("sessions").size();
    if (count != sessions_.size()) {
      fail(std::to_string(count) + " sessions in place of " + std::to_string(sessions_.size()));
    }
    for (const std::string& session : sessions_) {
      caller.result("session.join", {{"session", session}});
      caller.result("control.reset");
      caller.result("control.step", {{"ticks", 5}});
      caller.result("session.hash");
    }
  }

  void write(const ProcessFigures& before) {
    const auto megabytes = [](double bytes) { return 1e-6 * bytes; };
    const Table table{
        {"seconds", "sessions", "clients", "joins", "answered", "refused", "longest wait [s]",
         "frames", "rubbish", "flood", "closed", "stalls", "recordings", "resident at first [MB]",
         "most [MB]", "files", "threads", "faults"},
        {{seconds_, std::uint64_t{sessions_.size()}, std::uint64_t{options_.clients},
          tally_.joins.load(), tally_.requests.load(), tally_.refused.load(), tally_.longest(),
          tally_.frames.load(), tally_.garbage.load(), tally_.flood.load(), tally_.closed.load(),
          tally_.stalls.load(), tally_.recordings.load(), megabytes(before.resident),
          megabytes(*std::ranges::max_element(resident_)), std::uint64_t{after_.files},
          std::uint64_t{after_.threads}, std::uint64_t{faults_}}}};
    std::cout << to_markdown(table);
    Table samples{{"sample", "resident [MB]"}, {}};
    for (std::size_t i = 0; i < resident_.size(); ++i) {
      samples.rows.push_back({std::uint64_t{i}, megabytes(resident_[i])});
    }
    Table rests{{"rest", "resident [MB]", "heap in use [MB]"}, {}};
    for (std::size_t i = 0; i < resting_heap_.size(); ++i) {
      rests.rows.push_back({std::uint64_t{i}, megabytes(resting_[i]), megabytes(resting_heap_[i])});
    }
    std::cout << to_markdown(rests);
    for (const Status& written : {write_table(table, options_.output, "soak", "# Soak"),
                                  write_table(rests, options_.output, "rests", "# Rests"),
                                  write_table(samples, options_.output, "memory", "# Memory")}) {
      if (!written) fail("the results cannot be written");
    }
  }

  const SoakOptions options_;
  Tally tally_;
  script::ServerProcess server_;
  std::vector<std::string> sessions_;
  std::vector<double> resident_;      // while clients are connected [bytes]
  std::vector<double> resting_;       // after clients have left [bytes]
  std::vector<double> resting_heap_;  // heap in use then [bytes]
  ProcessFigures after_;              // at the last rest
  double seconds_ = 0;
  std::size_t faults_ = 0;
};

int soak(const SoakOptions& options) {
  const std::size_t files = options.clients + kSoakOtherFiles;
  if (raise_open_files(files) < files) {
    std::cerr << "soak: the system does not allow " << files << " open files (ulimit -n)\n";
    return kExitFailed;
  }
  try {
    return Soak(options).run() ? kExitOk : kExitFailed;
  } catch (const std::exception& error) {
    std::cerr << "soak: " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace

void add_soak_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("soak", "Load test with many sessions and all kinds of clients");
  const auto options = std::make_shared<SoakOptions>();
  const auto add = [&](const char* name, auto& target, const char* help, double min, double max) {
    command->add_option(name, target, help)->check(CLI::Range(min, max))->capture_default_str();
  };
  add("--seconds", options->seconds, "Duration of the load", 1, 1e6);
  add("--sessions", options->sessions, "Sessions", 1, 1000);
  add("--clients", options->clients, "Clients, in equal numbers of each kind", 1, 10'000);
  add("--seed", options->seed, "Seed of the clients' choices", 0, 1e6);
  command->add_option("--program", options->program, "Program of the server")
      ->capture_default_str();
  command->add_option("--output", options->output, "Folder of the results and the server's data")
      ->capture_default_str();
  command->footer(
      "Exit codes: 0 all bounds hold, 1 a bound is exceeded or the test cannot run, 2 wrong "
      "usage.");
  command->callback([options, &exit_code] { exit_code = soak(*options); });
}

}  // namespace vat::bench
