// The parts of the stability run with scenes: adversarial, random, closed, long.

#include <filesystem>

#include "core/threads/thread_pool.h"
#include "tests/bench/stability/stability_parts.h"
#include "tests/stability/adversarial/adversarial.h"
#include "tests/stability/builders.h"
#include "tests/stability/closed_pairs.h"
#include "tests/stability/long_run.h"
#include "tests/stability/random/properties.h"
#include "tests/stability/random/random_scene.h"
#include "tests/stability/random/shrink.h"

namespace vat::bench {
namespace {

const char* text_of(stability::Expected expected) {
  switch (expected) {
    case stability::Expected::runs:
      return "runs";
    case stability::Expected::may_stop:
      return "runs, or the guard stops it";
    case stability::Expected::refusal:
      return "is refused";
  }
  return "";
}

void count_outcome(const stability::Outcome& outcome, StabilityCount& count) {
  ++count.scenes;
  count.non_finite += outcome.non_finite > 0 ? 1 : 0;
  count.aborts += outcome.ending == stability::Ending::broken ? 1 : 0;
  count.outside += outcome.most_outside;
  count.events += outcome.undone;
  count.retries += outcome.attempts - outcome.steps;
  count.stopped += outcome.ending == stability::Ending::stopped ? 1 : 0;
  count.wall_stops += outcome.wall_stops;
  count.refused += outcome.ending == stability::Ending::refused ? 1 : 0;
  count.faults += outcome.fault.empty() ? 0 : 1;
}

}  // namespace

Result<StabilityCount> run_adversarial_part(const Options& options) {
  std::vector<stability::AdversarialCase> cases = stability::adversarial_cases();
  const auto divided = stability::with_sub_steps(cases);
  cases.insert(cases.end(), divided.begin(), divided.end());
  if (!options.quick) {
    const auto others = stability::with_other_integrators(stability::adversarial_cases());
    cases.insert(cases.end(), others.begin(), others.end());
    const auto large = stability::large_adversarial_cases();
    cases.insert(cases.end(), large.begin(), large.end());
  }
  ThreadPoolRunner runner(options.threads);
  StabilityCount count;
  Table table{{"case", "expected", "ended", "particles", "steps", "attempts", "guard events",
               "wall stops", "outside", "message", "hash", "fault"},
              {}};
  for (const stability::AdversarialCase& adversarial : cases) {
    const stability::Outcome outcome = stability::run(adversarial, &runner);
    count_outcome(outcome, count);
    if (!outcome.fault.empty()) print_fault(adversarial.name, outcome.fault);
    table.rows.push_back({adversarial.name, std::string(text_of(adversarial.expected)),
                          std::string(to_string(outcome.ending)), std::uint64_t{outcome.particles},
                          outcome.steps, outcome.attempts, outcome.undone, outcome.wall_stops,
                          std::uint64_t{outcome.most_outside}, outcome.message,
                          hash_text(outcome.hash), outcome.fault});
  }
  const Status written = write_table(table, options.output, "adversarial", "# Adversarial scenes");
  if (!written) return written.errors();
  return count;
}

namespace {

stability::PropertyReport check_random(const Scene& scene, bool quick) {
  return stability::check_properties(scene, 0.5, quick ? 800 : 2000);
}

Status report_fault(const Scene& scene, const std::string& fault, const Options& options) {
  print_fault(scene.name, fault);
  const Scene least = stability::shrink(scene, [&](const Scene& candidate) {
    return !check_random(candidate, options.quick).fault.empty();
  });
  std::filesystem::create_directories(options.output);
  return stability::write_scene_file(
      least, std::filesystem::path(options.output) / (scene.name + ".json"));
}

}  // namespace

Result<StabilityCount> run_random_part(const Options& options) {
  const std::uint64_t seeds = options.quick ? 30 : 500;
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    scenes.push_back(stability::random_scene(seed));
    std::optional<Scene> divided = stability::with_sub_steps(scenes.back());
    if (!divided) continue;
    divided->name += "-sub-steps";
    scenes.push_back(*std::move(divided));
  }
  StabilityCount count;
  Table table{{"scene", "bodies", "particles", "integrator", "step [s]", "attempts", "guard events",
               "momentum error", "momentum bound", "momentum closes", "energy excess",
               "energy bound", "contact energy at the snapshot [J]", "hash", "fault"},
              {}};
  for (const Scene& scene : scenes) {
    const stability::PropertyReport report = check_random(scene, options.quick);
    ++count.scenes;
    count.events += report.undone;
    count.retries += report.undone;
    count.wall_stops += report.wall_stops;
    count.non_finite += report.fault == "not finite" ? 1 : 0;
    count.aborts += report.fault.starts_with("threw") ? 1 : 0;
    count.outside += report.outside;
    if (!report.fault.empty()) {
      ++count.faults;
      const Status written = report_fault(scene, report.fault, options);
      if (!written) return written.errors();
    }
    table.rows.push_back(
        {scene.name, std::uint64_t{scene.bodies.size()}, std::uint64_t{report.particles},
         std::string(to_string(scene.numerics.integrator)), scene.numerics.step, report.attempts,
         report.undone, report.momentum_error, report.momentum_bound, report.has_momentum_budget,
         report.energy_excess, report.energy_bound, report.contact_energy, hash_text(report.hash),
         report.fault});
  }
  const Status written = write_table(table, options.output, "random", "# Random scenes");
  if (!written) return written.errors();
  return count;
}

Result<StabilityCount> run_conservation_part(const Options& options) {
  constexpr Real kMomentum = 1e-12;
  constexpr Real kAngularMomentum = 1e-10;
  const std::uint32_t steps = options.quick ? 2000 : 10000;
  StabilityCount count;
  Table table{{"pairing", "steps", "|dP| / sum m |v|", "at most", "|dL| / sum m |x| |v|",
               "at most ", "momentum exchanged", "hash"},
              {}};
  for (const Scene& scene : stability::closed_pairs()) {
    const stability::ClosedRun run = stability::run_closed(scene, steps);
    ++count.scenes;
    count.events += run.undone;
    const bool good =
        run.momentum <= kMomentum && run.angular_momentum <= kAngularMomentum && run.undone == 0;
    if (!good) {
      ++count.faults;
      print_fault(run.name, "momentum is not conserved");
    }
    table.rows.push_back({run.name, std::uint64_t{steps}, run.momentum, kMomentum,
                          run.angular_momentum, kAngularMomentum, run.exchanged,
                          hash_text(run.hash)});
  }
  const Status written =
      write_table(table, options.output, "conservation", "# Conservation in closed scenes");
  if (!written) return written.errors();
  return count;
}

Result<StabilityCount> run_long_part(const Options& options) {
  const std::uint64_t steps = options.quick ? 20'000 : 1'000'000;
  StabilityCount count;
  Table table{{"scene", "steps", "quantity", "measured", "at most", "because", "within", "hash"},
              {}};
  for (const std::string& name : stability::long_run_names()) {
    ++count.scenes;
    for (const stability::LongRunRow& row : stability::run_long(name, steps)) {
      if (!row.is_within()) {
        ++count.faults;
        print_fault(row.scene + ", " + row.quantity,
                    short_text(row.value) + " of " + short_text(row.bound));
      }
      table.rows.push_back({row.scene, row.steps, row.quantity, row.value, row.bound, row.reason,
                            row.is_within(), hash_text(row.hash)});
    }
  }
  const Status written = write_table(table, options.output, "long-runs", "# Long runs");
  if (!written) return written.errors();
  return count;
}

}  // namespace vat::bench
