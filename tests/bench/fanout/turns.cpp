#include "tests/bench/fanout/turns.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "tests/bench/fanout/served.h"

namespace vat::bench {
namespace {

using std::chrono::milliseconds;

constexpr auto kStart = std::chrono::seconds(12);  // until the water reaches its periodic motion
constexpr auto kChange = milliseconds(1500);       // after viewers have joined or left
constexpr auto kSegment = std::chrono::seconds(6);
constexpr std::size_t kPairs = 10;
constexpr std::size_t kQuickPairs = 2;

std::size_t count_all_turns(const ViewerCounts& viewers) {
  return std::accumulate(viewers.begin(), viewers.end(), std::size_t{0});
}

/// Measurements of one segment.
struct Segment {
  std::vector<float> ticks;      // [s]
  std::vector<float> publishes;  // [s]
  std::vector<float> lateness;   // [s]
  std::vector<float> ages;       // [s] of the staying viewers' frames
  float memory = 0;              // [MB]
};

Segment measure_segment(const Served& server, LoadProcess* staying) {
  Segment segment;
  const std::size_t begin = server.log_size();
  if (staying != nullptr) staying->begin();
  std::this_thread::sleep_for(kSegment);
  for (const TickTimes& tick : server.ticks_since(begin)) {
    segment.ticks.push_back(static_cast<float>(tick.seconds));
    segment.publishes.push_back(static_cast<float>(tick.publish));
    segment.lateness.push_back(static_cast<float>(tick.lateness));
  }
  if (segment.ticks.empty()) throw std::runtime_error("the server's log tells of no tick");
  if (staying != nullptr) {
    segment.ages = staying->tell()[static_cast<std::size_t>(ViewerKind::plain)].ages;
  }
  segment.memory = static_cast<float>(static_cast<double>(server.resident_bytes()) / 1e6);
  return segment;
}

std::unique_ptr<LoadProcess> start(const LoadSettings& settings, const ViewerCounts& viewers,
                                   std::uint32_t seed) {
  if (count_all_turns(viewers) == 0) return nullptr;
  auto load = std::make_unique<LoadProcess>(settings, viewers, seed);
  load->wait_ready();
  return load;
}

/// Returns the values of `read` for the segments of each kind.
template <class Read>
TurnsResult gather(const TurnsCase& one, const char* quantity,
                   const std::array<std::vector<Segment>, 2>& segments, Read&& read) {
  TurnsResult result{one.name, quantity, count_all_turns(one.staying), count_all_turns(one.coming),
                     {},       {}};
  for (const Segment& segment : segments[0]) result.without.push_back(read(segment));
  for (const Segment& segment : segments[1]) result.with.push_back(read(segment));
  return result;
}

/// Returns the same result in milliseconds.
TurnsResult gather_times(const TurnsCase& one, const char* quantity,
                         const std::array<std::vector<Segment>, 2>& segments,
                         std::vector<float> Segment::*seconds) {
  return gather(one, quantity, segments, [&](const Segment& segment) {
    std::vector<float> times = segment.*seconds;
    for (float& time : times) time *= 1000;
    return times;
  });
}

}  // namespace

const std::vector<TurnsCase>& turns_cases() {
  static const std::vector<TurnsCase> kCases = {
      {"turns-200", {}, {200, 0, 0, 0}},
      {"turns-slow", {150, 0, 0, 0}, {0, 25, 25, 0}},
  };
  return kCases;
}

std::vector<TurnsResult> run_turns(const TurnsCase& one, const FanoutSettings& settings) {
  const std::size_t pairs = settings.seconds < 10 ? kQuickPairs : kPairs;
  const Served server(settings.program, {"--scene", settings.scene, "--log-level", "debug"},
                      settings.scene + "." + one.name + ".log");
  LoadSettings load{server.port(), settings.max_error, 0, "s1"};
  load.niceness = 19;
  load.half_bytes_per_second = measure_frame(load) * kFullRate / 2;
  const auto staying = start(load, one.staying, 0);
  std::this_thread::sleep_for(kStart);
  std::array<std::vector<Segment>, 2> segments;
  std::unique_ptr<LoadProcess> coming;
  for (std::size_t turn = 0; turn < 2 * pairs; ++turn) {
    const bool is_with = turn % 4 == 1 || turn % 4 == 2;
    if (is_with != (coming != nullptr)) {
      coming = is_with ? start(load, one.coming, 100'000) : nullptr;
      std::this_thread::sleep_for(kChange);
    }
    segments[is_with ? 1 : 0].push_back(measure_segment(server, staying.get()));
  }
  std::vector<TurnsResult> results{
      gather_times(one, "tick [ms]", segments, &Segment::ticks),
      gather_times(one, "tick lateness [ms]", segments, &Segment::lateness),
      gather_times(one, "publishing [ms]", segments, &Segment::publishes)};
  if (staying != nullptr) {
    results.push_back(gather_times(one, "age [ms]", segments, &Segment::ages));
  }
  results.push_back(gather(one, "resident [MB]", segments,
                           [](const Segment& segment) { return std::vector{segment.memory}; }));
  return results;
}

}  // namespace vat::bench
