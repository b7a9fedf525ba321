// The part of the stability run in which vats of liquid slide, shake and tilt.

#include <utility>
#include <vector>

#include "core/threads/thread_pool.h"
#include "tests/bench/stability/stability_parts.h"
#include "tests/stability/random/random_vat.h"

namespace vat::bench {

namespace {

struct Shaken {
  stability::RandomVat vat;
  stability::VatReport report;
};

/// Runs vats in parallel, since each is too small for several threads.
std::vector<Shaken> shake_all(std::uint64_t vats, std::size_t threads) {
  std::vector<Shaken> all;
  for (const PressureSolver solver :
       {PressureSolver::gas, PressureSolver::tait, PressureSolver::incompressible}) {
    for (std::uint64_t seed = 1; seed <= vats; ++seed) {
      stability::RandomVat vat = stability::random_vat(seed, solver);
      all.push_back({vat, {}});
      all.push_back({with_sub_steps(std::move(vat)), {}});
    }
  }
  ThreadPoolRunner runner(threads);
  runner.run(all.size(), [&](std::size_t n) { all[n].report = stability::shake(all[n].vat); });
  return all;
}

}  // namespace

Result<StabilityCount> run_vat_part(const Options& options) {
  StabilityCount count;
  Table table{{"vat", "bodies", "particles", "step [s]", "steps", "guard events", "wall stops",
               "outside", "greatest speed / speed of sound", "hash", "fault"},
              {}};
  for (const auto& [vat, report] : shake_all(options.quick ? 3 : 200, options.threads)) {
    ++count.scenes;
    count.events += report.events;
    count.retries += report.events;
    count.wall_stops += report.wall_stops;
    count.outside += report.outside;
    if (!report.fault.empty()) {
      ++count.faults;
      print_fault(vat.scene.name, report.fault);
    }
    table.rows.push_back({vat.scene.name, std::uint64_t{vat.scene.bodies.size()},
                          std::uint64_t{report.particles}, vat.scene.numerics.step, report.steps,
                          report.events, report.wall_stops, std::uint64_t{report.outside},
                          report.greatest_speed, hash_text(report.hash), report.fault});
  }
  const Status written = write_table(table, options.output, "vats", "# Vats of liquid");
  if (!written) return written.errors();
  return count;
}

}  // namespace vat::bench
