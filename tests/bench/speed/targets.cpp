#include "tests/bench/speed/targets.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

namespace vat::bench {

namespace {

struct Limit {
  const char* name;  ///< name of a case
  std::size_t threads;
  Real limit;
};

/// Maximum wall seconds per simulated second.
constexpr Limit kWallLimits[] = {
    {"peer-dam-break-10k-incompressible", 4, 0.8}, {"peer-dam-break-30k-incompressible", 4, 4},
    {"peer-dam-break-97k-incompressible", 4, 16},  {"peer-dam-break-10k-incompressible", 1, 2},
    {"peer-dam-break-30k-incompressible", 1, 9},   {"peer-dam-break-30k-tait", 4, 8}};

/// Minimum real-time factors.
constexpr Limit kRealTimeLimits[] = {{"sliding-vat-solids", 1, 4},
                                     {"sliding-vat-liquid", 1, 4},
                                     {"sliding-vat-solids", 4, 10},
                                     {"sliding-vat-liquid", 4, 10}};

constexpr Real kDensityErrorLimit = 5e-4;
constexpr Real kBytesLimit = 400;
constexpr Real kSizeLimit = 1.5;  // ratio of the times per particle at 100k and at 10k

Real pair_time_limit(InstructionSet set) {  // [ns]
  switch (set) {
    case InstructionSet::baseline:
      return 23;
    case InstructionSet::avx2:
      return 11;
    case InstructionSet::avx512:
      return 8;
  }
  return 0;
}

Real least_seconds_per_particle_step(const SpeedRow& row) {
  return row.seconds.front() / static_cast<Real>(row.steps) / static_cast<Real>(row.particles);
}

/// Returns the time of density, forces and the pair search per particle and step.
Real pair_seconds_per_particle_step(const SpeedRow& row) {
  constexpr std::string_view kStages[] = {"sort_liquid", "find_pairs", "liquid_density",
                                          "liquid_forces"};
  Real seconds = 0;
  for (const StageClock::Stage& stage : row.stages) {
    if (std::ranges::find(kStages, stage.name) != std::end(kStages)) seconds += stage.seconds();
  }
  return seconds / static_cast<Real>(row.steps) / static_cast<Real>(row.particles);
}

std::string threads_text(std::size_t threads) {
  return std::to_string(threads) + (threads == 1 ? " thread" : " threads");
}

/// Collects the targets of the available rows.
class TargetList {
 public:
  explicit TargetList(const std::vector<SpeedRow>& rows) : rows_(rows) {}

  const SpeedRow* find(std::string_view name, std::size_t threads) const {
    for (const SpeedRow& row : rows_) {
      if (row.name == name && row.threads == threads) return &row;
    }
    return nullptr;
  }
  void add_most(std::string what, Real limit, Real measured) {
    if (std::isfinite(measured)) targets.push_back({std::move(what), limit, false, measured});
  }
  void add_least(std::string what, Real limit, Real measured) {
    if (std::isfinite(measured)) targets.push_back({std::move(what), limit, true, measured});
  }

  std::vector<Target> targets;

 private:
  const std::vector<SpeedRow>& rows_;
};

void add_pair_time(TargetList& list) {
  if (const SpeedRow* row = list.find("dam-break-10k-tait", 1)) {
    list.add_most(std::string("ns per neighbour and step, dam-break-10k-tait, 1 thread, ") +
                      to_string(row->instructions),
                  pair_time_limit(row->instructions),
                  1e9 * pair_seconds_per_particle_step(*row) / row->flow.neighbours);
  }
  const SpeedRow* small = list.find("dam-break-10k-tait", 1);
  const SpeedRow* large = list.find("dam-break-100k-tait", 1);
  if (small == nullptr || large == nullptr) return;
  list.add_most("time per particle and step, dam-break-100k-tait over dam-break-10k-tait, 1 thread",
                kSizeLimit,
                least_seconds_per_particle_step(*large) / least_seconds_per_particle_step(*small));
}

void add_speed_ups(TargetList& list) {
  constexpr Limit kSpeedUps[] = {{"", 2, 1.8}, {"", 4, 3.3}};
  for (const char* name : {"dam-break-30k-tait", "dam-break-30k-incompressible"}) {
    const SpeedRow* one = list.find(name, 1);
    for (const Limit& limit : kSpeedUps) {
      const SpeedRow* many = list.find(name, limit.threads);
      if (one == nullptr || many == nullptr) continue;
      list.add_least("speed-up, " + std::string(name) + ", " + threads_text(limit.threads),
                     limit.limit, one->seconds.front() / many->seconds.front());
    }
  }
}

void add_wall_times(TargetList& list) {
  for (const auto& [name, threads, limit] : kWallLimits) {
    const SpeedRow* row = list.find(name, threads);
    if (row == nullptr) continue;
    list.add_most("wall s per simulated s, " + row->name + ", " + threads_text(threads), limit,
                  row->wall_per_simulated());
  }
  for (const auto& [name, threads, limit] : kRealTimeLimits) {
    const SpeedRow* row = list.find(name, threads);
    if (row == nullptr) continue;
    list.add_least("real-time factor, " + row->name + ", " + threads_text(threads), limit,
                   row->real_time_factor());
  }
}

/// Adds each case once, for any number of threads.
void add_properties(const std::vector<SpeedRow>& rows, TargetList& list) {
  const SpeedRow* last = nullptr;
  for (const SpeedRow& row : rows) {
    if (last != nullptr && last->name == row.name) continue;
    last = &row;
    if (row.name.starts_with("peer-dam-break") && row.solver == "incompressible") {
      list.add_most("density error, " + row.name, kDensityErrorLimit, row.flow.density_error);
    }
    if (row.liquid_particles == row.particles && row.particles >= 10'000) {
      list.add_most("bytes per particle, " + row.name, kBytesLimit, row.bytes_per_particle);
    }
  }
}

}  // namespace

std::vector<Target> targets_of(const std::vector<SpeedRow>& rows,
                               const std::vector<SkipResult>& skips) {
  TargetList list(rows);
  add_pair_time(list);
  add_speed_ups(list);
  add_wall_times(list);
  add_properties(rows, list);
  for (const SkipResult& skip : skips) {
    if (!skip.pair.most) continue;
    const SpeedRow& with = skip.with.front();
    const SpeedRow& without = skip.without.front();
    list.add_most("time with over without, " + skip.pair.name + ", " + threads_text(with.threads),
                  *skip.pair.most, with.wall_per_simulated() / without.wall_per_simulated());
  }
  return list.targets;
}

Table target_table(const std::vector<Target>& targets) {
  Table table{{"target", "limit", "measured", "passed"}, {}};
  for (const Target& target : targets) {
    const std::string limit =
        (target.is_least ? "at least " : "at most ") + short_text(target.limit);
    table.rows.push_back({target.what, limit, target.measured, target.passed()});
  }
  return table;
}

}  // namespace vat::bench
