#include "tests/bench/faults/fault_soak.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <vector>

#include "server/operations/heap.h"
#include "server/script/server_process.h"
#include "server/storage/session_store.h"
#include "tests/bench/faults/fault_clients.h"
#include "tests/bench/faults/log_causes.h"
#include "tests/bench/faults/shared_control.h"
#include "tests/bench/report/table.h"
#include "tests/bench/soak/caller.h"
#include "tests/bench/soak/process_figures.h"
#include "tests/bench/speed/machine.h"
#include "tests/support/pool_scene.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;
using FaultSeconds = std::chrono::duration<double>;

constexpr const char* kAdminToken = "admin-token-of-the-soak";
constexpr double kNormalTicks = 50;  // per second, of the scene
constexpr double kMinTickShare = 0.9;
constexpr double kMaxMemoryRatio = 1.1;
constexpr std::size_t kMaxMemory = std::size_t{400} << 20;
constexpr std::int64_t kBallast = std::int64_t{450} << 20;
constexpr std::int64_t kClockStep = std::int64_t{3600} * 1'000'000'000;  // [ns]
constexpr std::chrono::minutes kFaultPatience{1};
constexpr std::chrono::seconds kEffectPatience{10};
/// By then the server has released unused memory after it has closed all connections.
constexpr steady_clock::duration kRest = 2 * MemoryReturn::kInterval + std::chrono::seconds(2);
constexpr double kMebibyte = 1 << 20;

/// A line of the result.
struct Bound {
  std::string measure;
  double value = 0;
  std::string bound;
  bool passed = true;
};

class FaultSoak {
 public:
  explicit FaultSoak(const FaultOptions& options)
      : options_(options), folder_(make_folder(options)), control_(file("control")) {
    if (!write_text(file("admin-token"), std::string(kAdminToken) + '\n')) {
      throw std::runtime_error("cannot write in " + folder_.string());
    }
    setenv(kFaultVariable, file("control").c_str(), 1);
  }

  bool run() {
    start();
    create_sessions();
    // The memory after the first life counts as that of the start: all parts have been used then.
    live(false);
    const double calm_memory = memory_at_rest();
    kill();
    const auto end = steady_clock::now() + seconds(options_.seconds - options_.kill_every);
    for (bool is_last = false; !is_last;) {
      start();
      is_last = steady_clock::now() + seconds(options_.kill_every) >= end;
      live(!is_last);
    }
    const double memory = memory_at_rest();
    const int status = server_->stop();
    server_.reset();
    if (status != 0) tally_.add_fault("the server ended with " + std::to_string(status));
    return report(calm_memory, memory);
  }

 private:
  static std::filesystem::path make_folder(const FaultOptions& options) {
    const std::filesystem::path folder = std::filesystem::absolute(options.output);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder / "scenes");
    if (!write_text(folder / "scenes/pool.json", test::kPoolScene)) {
      throw std::runtime_error("cannot write in " + folder.string());
    }
    return folder;
  }
  std::string file(const char* name) const { return (folder_ / name).string(); }
  static steady_clock::duration seconds(double time) {
    return std::chrono::duration_cast<steady_clock::duration>(FaultSeconds(time));
  }

  /// Starts the server on its data, with the faults' library and a log, and waits until all
  /// sessions run.
  void start() {
    const auto begin = steady_clock::now();
    const std::string connections = std::to_string(3 * options_.clients + 10);
    const std::string sessions = std::to_string(2 * options_.sessions + 10);
    server_ = std::make_unique<script::ServerProcess>(
        "/bin/sh",
        std::vector<std::string>{
            "-c", "log=$1; shift; exec \"$@\" 2>>\"$log\"", "sh", file("server.log"), "env",
            // LD_PRELOAD admits no spaces in paths.
            "LD_LIBRARY_PATH=" VAT_FAULT_SHIM_FOLDER, "LD_PRELOAD=" VAT_FAULT_SHIM,
            options_.program, "serve", "--port", "0", "--scenes", file("scenes"), "--scene", "pool",
            "--data", file("data"), "--access", "token", "--admin-token-file", file("admin-token"),
            "--max-memory", std::to_string(kMaxMemory), "--max-sessions", sessions,
            "--max-sessions-per-address", sessions, "--max-connections-per-address", connections,
            "--resume-seconds", "2", "--log-level", "warn"});
    Caller caller = make_admin();
    const auto is_running = [](const Json& session) { return session.at("state") == "running"; };
    for (;;) {
      const Json sessions_now = caller.result("session.list").at("sessions");
      if (std::ranges::all_of(sessions_now, is_running) &&
          (places_.empty() || sessions_now.size() == places_.size())) {
        break;
      }
      if (steady_clock::now() > begin + kFaultPatience) {
        throw std::runtime_error("sessions are missing: " + sessions_now.dump());
      }
      caller.read_for(std::chrono::milliseconds(10));
    }
    recovery_ = std::max(recovery_, FaultSeconds(steady_clock::now() - begin).count());
  }

  Caller make_admin() {
    Caller caller(server_->port(), tally_);
    caller.result("access.enter", {{"token", kAdminToken}});
    return caller;
  }

  void create_sessions() {
    for (std::size_t i = 0; i < options_.sessions; ++i) {
      Caller caller = make_admin();
      const std::string session =
          i == 0 ? caller.result("session.list").at("sessions")[0].at("session").get<std::string>()
                 : caller.result("session.create", {{"name", "one"}, {"scene", "pool"}})
                       .at("session")
                       .get<std::string>();
      caller.result("session.join", {{"session", session}});
      caller.result("control.play");
      const Json invited = caller.result("session.invite", {{"role", "viewer"}});
      places_.push_back({0, session, kAdminToken, invited.at("token")});
    }
  }

  void kill() {
    server_->kill();
    ++kills_;
  }

  /// Lets all clients come, and injects each fault once. At the end of the life, kills the server
  /// or lets the clients leave.
  void live(bool ends_by_kill) {
    LifeNotes notes;
    std::vector<std::thread> clients;
    for (std::size_t i = 0; i < options_.clients; ++i) {
      FaultPlace place = places_[i % places_.size()];
      place.port = server_->port();
      clients.emplace_back([this, &notes, place, manner = manner_of(i), name = ++last_name_] {
        run_fault_client(manner, place, name, notes, tally_);
      });
    }
    inject_faults(notes);
    notes.ends = true;
    if (ends_by_kill) kill();
    for (std::thread& client : clients) client.join();
    check(notes);
  }

  /// The second half of the clients has invalid tokens.
  FaultManner manner_of(std::size_t client) const {
    if (client >= options_.clients / 2) return FaultManner::stranger;
    if (client < places_.size()) return FaultManner::commanding;
    constexpr FaultManner kOthers[] = {FaultManner::slow, FaultManner::silent,
                                       FaultManner::malformed, FaultManner::reconnecting,
                                       FaultManner::flooding};
    return kOthers[client % std::size(kOthers)];
  }

  void inject_faults(const LifeNotes& notes) {
    const auto wait = [begin = steady_clock::now(), this](double part) {
      std::this_thread::sleep_until(begin + seconds(part * options_.kill_every));
    };
    const auto wait_for_effect = [](const auto& has_effect) {
      const auto deadline = steady_clock::now() + kEffectPatience;
      while (!has_effect() && steady_clock::now() < deadline) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    };
    wait(0.2);
    const std::uint32_t syncs = control_->delayed_syncs;
    control_->disk_paused = 1;
    wait(0.23);
    wait_for_effect([&] { return control_->delayed_syncs > syncs; });
    control_->disk_paused = 0;
    wait(0.4);
    control_->clock_step = kClockStep;
    wait(0.5);
    control_->clock_step = -kClockStep;
    clock_steps_ += 2;
    wait(0.6);
    control_->ballast = kBallast;
    wait(0.7);
    wait_for_effect([&] { return notes.memory_refusals > 0; });
    control_->ballast = 0;
    wait(1);
  }

  /// Compares the life's notes with the log on the disk.
  void check(const LifeNotes& notes) {
    strangers_refused_ += notes.strangers_refused;
    strangers_admitted_ += notes.strangers_admitted;
    memory_refusals_ += notes.memory_refusals;
    reconnects_ += notes.reconnects;
    for (const auto& [session, rate] : notes.tick_rates()) tick_rates_.push_back(rate);
    SessionStore store(file("data/vat.db"));
    for (const auto& [session, commands] : notes.answered()) {
      const std::uint64_t number = std::stoull(session.substr(1));
      const std::multiset<std::string> stored = read_new(store, number);
      answered_ += commands.size();
      for (const std::string& command : commands) {
        if (stored.contains(command)) continue;
        ++lost_;
        tally_.add_fault(session + " has lost " + command);
      }
    }
  }

  /// Returns the commands of a session since the last call.
  std::multiset<std::string> read_new(SessionStore& store, std::uint64_t session) {
    std::multiset<std::string> commands;
    std::uint64_t& last = read_[session];
    for (auto entries = store.read(session, last); !entries.empty();
         entries = store.read(session, last)) {
      for (const LogEntry& entry : entries) {
        last = entry.sequence;
        if (!entry.refused) commands.insert(command_text(entry.method, entry.params));
      }
    }
    return commands;
  }

  double memory_at_rest() {
    std::this_thread::sleep_for(std::min(kRest, seconds(options_.kill_every)));
    return process_figures(server_->process()).resident;
  }

  bool report(double calm_memory, double memory) {
    std::stringstream log;
    log << std::ifstream(file("server.log")).rdbuf();
    const LoggedCauses causes = find_causes(log.str());
    for (const std::string& line : causes.unexplained)
      std::cout << "without cause: " << line << '\n';
    const std::vector<std::string> faults = tally_.faults();
    for (const std::string& fault : faults) std::cout << "FAULT: " << fault << '\n';
    if (tick_rates_.empty()) throw std::runtime_error("no ticks were seen");
    const double share = *std::ranges::min_element(tick_rates_) / kNormalTicks;
    std::size_t explained = 0;
    for (const auto& [cause, count] : causes.counts) explained += count;

    std::vector<Bound> bounds;
    const auto count = [&](const char* measure, auto value, const char* bound, bool passed) {
      bounds.push_back({measure, static_cast<double>(value), bound, passed});
    };
    count("kills", kills_, "", true);
    count("answered commands", answered_, "at least 1", answered_ > 0);
    count("lost commands", lost_, "0", lost_ == 0);
    count("longest recovery of all sessions [s]", recovery_, "", true);
    count("lowest tick rate of a session / normal", share, "at least 0.9", share >= kMinTickShare);
    count("memory after the soak / before", memory / calm_memory, "at most 1.1",
          memory <= kMaxMemoryRatio * calm_memory);
    count("memory before [MiB]", calm_memory / kMebibyte, "", true);
    count("wrong tokens, rejected", strangers_refused_, "at least 1", strangers_refused_ > 0);
    count("wrong tokens, accepted", strangers_admitted_, "0", strangers_admitted_ == 0);
    count("invalid messages", tally_.garbage.load(), "at least 1", tally_.garbage > 0);
    count("messages beyond the limits", tally_.flood.load(), "at least 1", tally_.flood > 0);
    count("reconnections", reconnects_, "at least 1", reconnects_ > 0);
    count("syncs during pauses of the disk", control_->delayed_syncs.load(), "at least 1",
          control_->delayed_syncs > 0);
    count("steps of the clock", clock_steps_, "at least 1", clock_steps_ > 0);
    count("commands rejected for lack of memory", memory_refusals_, "at least 1",
          memory_refusals_ > 0);
    count("warnings and errors with a known cause", explained, "", true);
    count("warnings and errors without", causes.unexplained.size(), "0",
          causes.unexplained.empty());
    count("other faults", faults.size(), "0", faults.empty());
    return write(bounds, causes);
  }

  bool write(const std::vector<Bound>& bounds, const LoggedCauses& causes) const {
    const Machine machine = this_machine();
    Table table{{"measure", "value", "bound", "passed", "commit", "cpu", "cores"}, {}};
    for (const Bound& one : bounds) {
      table.rows.push_back({one.measure, one.value, one.bound, one.passed, machine.commit,
                            machine.cpu, std::uint64_t{machine.cores}});
    }
    Table logged{{"cause", "lines"}, {}};
    for (const auto& [cause, count] : causes.counts) {
      logged.rows.push_back({cause, std::uint64_t{count}});
    }
    std::cout << to_markdown(table) << to_markdown(logged);
    if (!write_table(table, folder_, "faults", "# Faults") ||
        !write_table(logged, folder_, "causes", "# Causes of warnings and errors")) {
      throw std::runtime_error("cannot write in " + folder_.string());
    }
    return std::ranges::all_of(bounds, &Bound::passed);
  }

  const FaultOptions options_;
  const std::filesystem::path folder_;
  SharedControl control_;
  Tally tally_;
  std::unique_ptr<script::ServerProcess> server_;
  std::vector<FaultPlace> places_;
  std::map<std::uint64_t, std::uint64_t> read_;  ///< last checked log entry of each session
  std::vector<double> tick_rates_;               ///< of each session in each life
  std::uint32_t last_name_ = 0;
  std::size_t kills_ = 0, answered_ = 0, lost_ = 0, clock_steps_ = 0;
  std::uint64_t strangers_refused_ = 0, strangers_admitted_ = 0, memory_refusals_ = 0,
                reconnects_ = 0;
  double recovery_ = 0;
};

}  // namespace

bool run_fault_soak(const FaultOptions& options) {
  return FaultSoak(options).run();
}

}  // namespace vat::bench
