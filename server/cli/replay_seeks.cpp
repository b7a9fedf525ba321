#include "server/cli/replay_seeks.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <iostream>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "server/replay/replay_player.h"
#include "server/support/clock.h"

namespace vat {
namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;
using Seconds = std::chrono::duration<double>;

constexpr double kMebibyte = 1 << 20;

std::string describe(std::vector<double>& times) {
  std::ranges::sort(times);
  const auto part = [&](double of) {
    return times[static_cast<std::size_t>(of * static_cast<double>(times.size() - 1))];
  };
  std::ostringstream text;
  text << "median " << part(0.5) << " ms, 99 % below " << part(0.99) << " ms, longest "
       << times.back() << " ms";
  return text.str();
}

void time_some(const Recording& recording, const SessionEnvironment& environment,
               const std::shared_ptr<MomentCache>& moments, std::size_t count) {
  // Adds no moments, so that each seek finds the same ones.
  ReplayPlayer player(recording, environment);
  player.share(moments);
  SessionCore core("replay", {recording.name}, player.begin(), environment);
  player.go_to_begin(core);
  const std::atomic<bool> cancelled = false;
  std::mt19937_64 random(1);
  std::vector<double> times;
  std::vector<double> restoring;
  std::uint64_t most_ticks = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t span = recording.end - recording.begin + 1;
    const std::uint64_t position = recording.begin + random() % span;
    const auto begin = CostClock::now();
    player.begin_seek(core, position);
    restoring.push_back(Milliseconds(CostClock::now() - begin).count());
    most_ticks = std::max(most_ticks, position - core.run().position());
    player.play_to(core, position, cancelled);
    times.push_back(Milliseconds(CostClock::now() - begin).count());
  }
  std::cout << count << " seeks, of at most " << most_ticks << " ticks: " << describe(times)
            << "; the state to begin at: " << describe(restoring) << std::endl;
}

/// Adds moments as a server does while a replay is viewed.
void play_once(const Recording& recording, const SessionEnvironment& environment,
               const std::shared_ptr<MomentCache>& moments) {
  ReplayPlayer player(recording, environment);
  player.share(moments);
  SessionCore core("replay", {recording.name}, player.begin(), environment);
  player.go_to_begin(core);
  player.play_to(core, recording.end, false);
}

}  // namespace

void time_seeks(const Recording& recording, const SessionEnvironment& environment,
                std::size_t count) {
  std::size_t bytes = 0;
  std::uint64_t widest = 0;
  std::uint64_t last = recording.begin;
  for (const RecordedMoment& moment : recording.moments) {
    bytes += moment.state.size() + moment.fields.size();
    widest = std::max(widest, moment.position - last);
    last = moment.position;
  }
  widest = std::max(widest, recording.end - last);
  std::cout << recording.moments.size() << " moments recorded, "
            << static_cast<double>(bytes) / kMebibyte << " MiB, at most " << widest
            << " ticks apart; " << recording.hashes.size() << " hashes" << std::endl;
  const ReplayPlayer::CacheSettings keeping;
  const auto none = std::make_shared<MomentCache>(Seconds(1e9), keeping.most_bytes);
  time_some(recording, environment, none, count);

  const auto moments = std::make_shared<MomentCache>(keeping.work, keeping.most_bytes);
  const auto begin = CostClock::now();
  play_once(recording, environment, moments);
  std::cout << moments->count() << " moments filled in, "
            << static_cast<double>(moments->bytes()) / kMebibyte << " MiB, in "
            << Seconds(CostClock::now() - begin).count() << " s\n";
  time_some(recording, environment, moments, count);
}

}  // namespace vat
