#include "tests/bench/fanout/case.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <numeric>
#include <thread>
#include <utility>

#include "tests/bench/fanout/served.h"
#include "tests/bench/report/quantile.h"

namespace vat::bench {
namespace {

constexpr std::size_t kViewersPerProcess = 1000;
constexpr std::size_t kDefaultConnections = 1024;  // of the server
constexpr std::size_t kDefaultConnectionsPerAddress = 256;
constexpr auto kSettling = std::chrono::seconds(3);

void sleep(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

std::size_t count_all(const ViewerCounts& viewers) {
  return std::accumulate(viewers.begin(), viewers.end(), std::size_t{0});
}

bool is_silent(const FanoutCase& one) {
  return one.viewers[static_cast<std::size_t>(ViewerKind::silent)] > 0;
}

std::vector<std::string> server_arguments(const FanoutCase& one, const FanoutSettings& settings) {
  const std::string& scene = is_silent(one) ? settings.solids_scene : settings.scene;
  std::vector<std::string> words{"--scene", scene, "--log-level", "error"};
  const std::size_t viewers = count_all(one.viewers);
  if (one.endpoints > 1) {
    words.insert(words.end(), {"--endpoints", std::to_string(one.endpoints)});
  }
  if (viewers > kDefaultConnectionsPerAddress) {
    const std::string most = std::to_string(viewers + kDefaultConnections);
    words.insert(words.end(), {"--max-connections", most, "--max-connections-per-address", most,
                               "--max-clients", most});
  }
  return words;
}

ViewerCounts share_of(const ViewerCounts& viewers, std::size_t process, std::size_t processes) {
  ViewerCounts share{};
  for (std::size_t kind = 0; kind < kViewerKinds; ++kind) {
    share[kind] = viewers[kind] * (process + 1) / processes - viewers[kind] * process / processes;
  }
  return share;
}

std::vector<std::unique_ptr<LoadProcess>> start_load(const LoadSettings& settings,
                                                     const ViewerCounts& viewers) {
  const std::size_t processes =
      std::max<std::size_t>(1, (count_all(viewers) + kViewersPerProcess / 2) / kViewersPerProcess);
  std::vector<std::unique_ptr<LoadProcess>> load;
  for (std::size_t p = 0; p < processes; ++p) {
    load.push_back(std::make_unique<LoadProcess>(settings, share_of(viewers, p, processes),
                                                 static_cast<std::uint32_t>(p * 100'000)));
  }
  for (const auto& process : load) process->wait_ready();
  return load;
}

void append_values(std::vector<float>& all, const std::vector<float>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

LoadSightings end_load(const std::vector<std::unique_ptr<LoadProcess>>& load) {
  LoadSightings all;
  for (const auto& process : load) append(all, process->end());
  return all;
}

double metric(const std::map<std::string, double>& metrics, const std::string& name) {
  const auto found = metrics.find(name);
  return found == metrics.end() ? FanoutResult::kAbsent : found->second;
}

double count_ticks(const Served& server) {
  return metric(server.metrics(), "vat_tick_duration_seconds_count");
}

void read_ticks(const Served& server, FanoutResult& result) {
  const auto metrics = server.metrics();
  result.tick_median = metric(metrics, "vat_recent_tick_seconds{quantile=\"0.5\"}");
  result.tick_99 = metric(metrics, "vat_recent_tick_seconds{quantile=\"0.99\"}");
  result.lateness_99 = metric(metrics, "vat_recent_tick_lateness_seconds{quantile=\"0.99\"}");
}

}  // namespace

void append(LoadSightings& all, const LoadSightings& more) {
  for (std::size_t kind = 0; kind < kViewerKinds; ++kind) {
    all[kind].frames += more[kind].frames;
    all[kind].bytes += more[kind].bytes;
    all[kind].joins += more[kind].joins;
    all[kind].closed += more[kind].closed;
    append_values(all[kind].ages, more[kind].ages);
    append_values(all[kind].first_frames, more[kind].first_frames);
  }
}

FanoutResult summarise(const Sightings& seen, std::size_t viewers, double seconds) {
  FanoutResult result;
  result.viewers = viewers;
  result.frames_per_second =
      static_cast<double>(seen.frames) / seconds / static_cast<double>(viewers);
  if (seen.frames > 0) {
    result.frame_bytes = static_cast<double>(seen.bytes) / static_cast<double>(seen.frames);
  }
  result.age_median = static_cast<double>(quantile(seen.ages, 0.5));
  result.age_99 = static_cast<double>(quantile(seen.ages, 0.99));
  result.first_frame_99 = static_cast<double>(quantile(seen.first_frames, 0.99));
  result.joins = seen.joins;
  result.closed = seen.closed;
  return result;
}

double measure_frame(LoadSettings settings) {
  LoadProcess one(settings, {1, 0, 0, 0}, 1);
  one.wait_ready();
  one.begin();
  sleep(1);
  const Sightings seen = one.end().front();
  return static_cast<double>(seen.bytes) /
         static_cast<double>(std::max<std::uint64_t>(1, seen.frames));
}

const std::vector<FanoutCase>& fanout_cases() {
  static const std::vector<FanoutCase> kCases = {
      {"viewers-1", {1, 0, 0, 0}, 1},
      {"viewers-200", {200, 0, 0, 0}, 1},
      {"viewers-1000", {1000, 0, 0, 0}, 1},
      {"viewers-2000", {2000, 0, 0, 0}, 2},
      {"half-speed", {199, 1, 0, 0}, 1},
      {"stalled", {199, 0, 1, 0}, 1},
      {"half-speed-50", {150, 50, 0, 0}, 1},
      {"stalled-50", {150, 0, 50, 0}, 1},
      {"restless-50", {150, 0, 0, 50}, 1},
      {"readers-1", {0, 0, 0, 0, 1}, 1},
      {"readers-10", {0, 0, 0, 0, 10}, 1},
      {"readers-50", {0, 0, 0, 0, 50}, 1},
      {"silent-1000", {0, 0, 0, 0, 0, 1000}, 1},
  };
  return kCases;
}

std::vector<FanoutResult> run_fanout(const FanoutCase& one, const FanoutSettings& settings) {
  const Served server(settings.program, server_arguments(one, settings));
  LoadSettings load_settings{server.port(), settings.max_error, 0, "s1"};
  load_settings.half_bytes_per_second = measure_frame(load_settings) * kFullRate / 2;
  const auto resident_before = static_cast<double>(server.resident_bytes());

  const auto load = start_load(load_settings, one.viewers);
  std::this_thread::sleep_for(kSettling);
  const auto begin = LoadClock::now();
  for (const auto& process : load) process->begin();
  const double before = server.processor_seconds();
  const double delivery_before = server.delivery_seconds();
  const double ticks_before = count_ticks(server);
  sleep(settings.seconds);
  const double processor = server.processor_seconds() - before;
  const double delivery = server.delivery_seconds() - delivery_before;
  const double ticks = count_ticks(server) - ticks_before;
  const std::uint64_t resident = server.resident_bytes();
  const LoadSightings seen = end_load(load);
  const double seconds = std::chrono::duration<double>(LoadClock::now() - begin).count();

  std::vector<FanoutResult> results;
  for (std::size_t kind = 0; kind < kViewerKinds; ++kind) {
    if (one.viewers[kind] == 0) continue;
    FanoutResult result = summarise(seen[kind], one.viewers[kind], seconds);
    result.name = one.name;
    result.kind = static_cast<ViewerKind>(kind);
    result.endpoints = one.endpoints;
    result.delivery_per_viewer = delivery / seconds / static_cast<double>(count_all(one.viewers));
    result.processor = processor / seconds;
    result.resident_megabytes = static_cast<double>(resident) / 1e6;
    result.kilobytes_per_viewer = (static_cast<double>(resident) - resident_before) / 1e3 /
                                  static_cast<double>(count_all(one.viewers));
    result.ticks = ticks / seconds;
    read_ticks(server, result);
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace vat::bench
