#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

#include "core/limits.h"
#include "protocol/messages/describe.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"
#include "server/cli/replay_seeks.h"
#include "server/operations/log_format.h"
#include "server/replay/log_replay.h"
#include "server/replay/replay_player.h"
#include "server/rpc/method_table.h"

namespace vat {
namespace {

constexpr std::uint64_t kMaxLines = 200;  // about so many of the hashes are printed

struct ReplayOptions {
  std::string file;
  std::string scenes_folder = installed_scenes_folder();
  bool verify = false;
  std::size_t seeks = 0;
};

/// Environment of a session without a server.
class StandaloneEnvironment {
 public:
  explicit StandaloneEnvironment(const Catalogue& catalogue, InstructionSet instructions)
      : runner_(std::max(1U, std::thread::hardware_concurrency())),
        environment_{catalogue, limits_,    instructions,     runner_,
                     metrics_,  resources_, frame_threads_,   read_threads_,
                     tokens_,   clock_,     session_methods()} {
    limits_.max_particles = kMaxParticles;
    limits_.max_springs = kMaxSprings;
    limits_.max_particle_steps_per_tick = kMaxParticles * kMaxStepsPerTick;
  }
  const SessionEnvironment& get() const { return environment_; }

 private:
  ServerLimits limits_;
  ThreadPoolRunner runner_;
  ServerMetrics metrics_;
  ResourceBudget resources_{kUnlimitedResources};
  SystemClock clock_;
  AccessTokens tokens_{1, clock_};
  // After the other members, because tasks of these threads use them until the threads end.
  boost::asio::thread_pool frame_threads_{1};
  boost::asio::thread_pool read_threads_{1};
  const SessionEnvironment environment_;
};

Result<Recording> read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file.good() && !file.eof()) return Error{"not_readable", "", "cannot be read"};
  return read_recording({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

void print_place(const SessionCore& core, std::uint64_t hash) {
  std::cout << "position " << core.run().position() << ", tick " << core.run().tick() << ", hash "
            << describe_hash(hash) << '\n';
}

int play(const ReplayOptions& options, const Recording& recording, const Catalogue& catalogue) {
  const StandaloneEnvironment environment(catalogue, recording.instructions);
  if (options.seeks > 0) {
    time_seeks(recording, environment.get(), options.seeks);
    return kExitOk;
  }
  ReplayPlayer player(recording, environment.get());
  SessionCore core("replay", {recording.name}, player.begin(), environment.get());
  std::size_t compared = 0;
  std::uint64_t print_from = 0;
  player.on_same = [&](const RecordedHash& same) {
    ++compared;
    if (!options.verify || (same.position < print_from && same.position != recording.end)) return;
    print_place(core, same.hash);
    print_from = same.position + (recording.end - recording.begin) / kMaxLines;
  };
  if (options.verify) player.compare_moments();
  const std::atomic<bool> cancelled = false;
  const auto begin = std::chrono::steady_clock::now();
  player.go_to_begin(core);
  player.play_to(core, recording.end, cancelled);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  if (!options.verify) print_place(core, core.run().simulation().state_hash());
  std::cout << recording.end - recording.begin << " ticks, " << recording.log.size() << " entries, "
            << compared << " hashes the same, in " << time.count() << " s\n";
  if (!options.verify || compared > 0) return kExitOk;
  std::cerr << options.file << ": there is no hash to compare with\n";
  return kExitFailed;
}

int replay(const ReplayOptions& options) {
  start_log("error", false);
  const Result<Recording> recording = read_file(options.file);
  if (!recording) return fail(options.file, recording.errors());
  const Result<Catalogue> catalogue = Catalogue::open(options.scenes_folder);
  if (!catalogue) return fail(options.scenes_folder, catalogue.errors());
  try {
    return play(options, recording.value(), catalogue.value());
  } catch (const Diverged& difference) {
    std::cerr << options.file << ": differs: " << difference.what() << '\n';
  } catch (const StorageError& error) {
    std::cerr << options.file << ": " << error.what() << '\n';
  }
  return kExitFailed;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand(
      "replay", "Replay a recording of a session, and compare its states with the recorded states");
  const auto options = std::make_shared<ReplayOptions>();
  command->add_option("file", options->file, "Recording, in .vatrec")
      ->required()
      ->check(CLI::ExistingFile);
  command->add_flag("--verify", options->verify,
                    "Also compare all stored states, and print the hash of each tick");
  command
      ->add_option("--seeks", options->seeks,
                   "Measure the time of this number of seeks to random positions instead")
      ->check(CLI::Range(1, 1'000'000));
  command->add_option("--scenes", options->scenes_folder, "Folder of the catalogue");
  command->footer(
      "Exit codes: 0 replayed to the end, 1 not a recording, or a state that differs (its tick is "
      "printed), 2 wrong usage.");
  command->callback([options, &exit_code] { exit_code = replay(*options); });
}

}  // namespace vat
