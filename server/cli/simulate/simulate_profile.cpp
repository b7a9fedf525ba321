#include "server/cli/simulate/simulate_profile.h"

#include <algorithm>
#include <iomanip>
#include <string>
#include <vector>

namespace vat {

namespace {

using Seconds = std::chrono::duration<double>;

void print_row(std::ostream& out, std::string_view name, const std::string& calls, Seconds time,
               Seconds stepping) {
  const double share = stepping.count() > 0 ? 100 * time / stepping : 0;
  out << std::left << std::setw(24) << name << std::right << std::setw(12) << calls << std::fixed
      << std::setprecision(3) << std::setw(14) << time.count() * 1e3 << std::setprecision(1)
      << std::setw(8) << share << " %\n";
}

}  // namespace

void print_profile(const StageClock& profile, Seconds stepping, std::ostream& out) {
  std::vector<StageClock::Stage> sorted = profile.stages();
  std::ranges::stable_sort(sorted, std::ranges::greater(), &StageClock::Stage::time);
  out << std::left << std::setw(24) << "stage" << std::right << std::setw(12) << "calls"
      << std::setw(14) << "ms total" << std::setw(10) << "share" << '\n';
  Seconds rest = stepping;
  for (const StageClock::Stage& stage : sorted) {
    print_row(out, stage.name, std::to_string(stage.calls), stage.time, stepping);
    rest -= stage.time;
  }
  print_row(out, "(between stages)", "", rest, stepping);
}

}  // namespace vat
