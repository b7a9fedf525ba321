#include "server/cli/simulate_profile.h"

#include <algorithm>
#include <iomanip>

namespace vat {

namespace {

void print_row(std::ostream& out, const std::string& name, const std::string& calls,
               std::chrono::duration<double> time, std::chrono::duration<double> stepping) {
  const double share = stepping.count() > 0 ? 100 * time / stepping : 0;
  out << std::left << std::setw(24) << name << std::right << std::setw(12) << calls << std::fixed
      << std::setprecision(3) << std::setw(14) << time.count() * 1e3 << std::setprecision(1)
      << std::setw(8) << share << " %\n";
}

}  // namespace

StageProfile::Stage& StageProfile::find(std::string_view name) {
  const auto stage = std::ranges::find(stages_, name, &Stage::name);
  if (stage != stages_.end()) return *stage;
  Stage& added = stages_.emplace_back();
  added.name = name;
  return added;
}

void StageProfile::stage_begins(std::string_view stage) {
  find(stage).begin = Clock::now();
}

void StageProfile::stage_ends(std::string_view stage) {
  const Clock::time_point now = Clock::now();
  Stage& ended = find(stage);
  ended.total += now - ended.begin;
  ++ended.calls;
}

void StageProfile::print(std::ostream& out, std::chrono::duration<double> stepping) const {
  std::vector<Stage> sorted = stages_;
  std::ranges::stable_sort(sorted, std::ranges::greater(), &Stage::total);
  out << std::left << std::setw(24) << "stage" << std::right << std::setw(12) << "calls"
      << std::setw(14) << "ms total" << std::setw(10) << "share" << '\n';
  std::chrono::duration<double> rest = stepping;
  for (const Stage& stage : sorted) {
    print_row(out, stage.name, std::to_string(stage.calls), stage.total, stepping);
    rest -= stage.total;
  }
  print_row(out, "(between stages)", "", rest, stepping);
}

}  // namespace vat
