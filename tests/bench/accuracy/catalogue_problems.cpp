#include "tests/bench/accuracy/problem.h"

namespace vat::bench {

using validation::Run;

namespace {

/// A catalogue scene until after its first impacts. Later the particle paths diverge with every
/// method.
Problem first_impacts(const std::string& name, TaskRunner* runner) {
  Problem problem{.title = "Scene " + name + ", its first 0.3 s",
                  .error_name = "centres of mass against a fine run, in ways from the start",
                  .scene = load_catalogue(name),
                  .end = 0.3,
                  .step_counts = doubled(75, 5),
                  .longest_step_count = 75,
                  .error = {}};
  constexpr int kFiner =
      2;  // factor relative to the finest steps; the order is 4 except at contacts
  const Real step = problem.end / (static_cast<Real>(kFiner) * problem.step_counts.back());
  Run fine(validation::with_method(problem.scene, IntegratorId::runge_kutta_4, step), runner);
  const std::vector<Vec3> start = centers_of(fine);
  fine.advance_to(problem.end);
  const std::vector<Vec3> expected = centers_of(fine);
  problem.error = [expected, size = distance(start, expected)](const Run& run) {
    return distance(centers_of(run), expected) / size;
  };
  return problem;
}

}  // namespace

std::vector<ProblemEntry> catalogue_problems() {
  std::vector<ProblemEntry> problems;
  for (const std::string name : {"rigid-stack", "deformable-drop", "sliding-vat-solids",
                                 "dam-break", "sliding-vat-liquid"}) {
    problems.push_back(
        {name, [name](TaskRunner* runner) { return first_impacts(name, runner); }, true});
  }
  return problems;
}

}  // namespace vat::bench
