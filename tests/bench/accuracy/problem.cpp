#include "tests/bench/accuracy/problem.h"

#include <cmath>
#include <iterator>
#include <limits>

namespace vat::bench {

using validation::Run;

namespace {

std::vector<Vec3> all_positions(const Run& run) {
  std::vector<Vec3> positions;
  for (const BodyView& body : run.simulation().bodies()) {
    positions.insert(positions.end(), body.positions.begin(), body.positions.end());
  }
  return positions;
}

std::vector<ProblemEntry> collect() {
  std::vector<ProblemEntry> problems;
  for (const auto group : {deformable_problems, rigid_problems}) {
    std::ranges::move(group(), std::back_inserter(problems));
  }
  return problems;
}

}  // namespace

const std::vector<ProblemEntry>& all_problems() {
  static const std::vector<ProblemEntry> problems = collect();
  return problems;
}

std::vector<std::uint32_t> doubled(std::uint32_t first, int count) {
  std::vector<std::uint32_t> counts;
  for (int i = 0; i < count; ++i) counts.push_back(first << i);
  return counts;
}

std::function<Real(const Run&)> error_against_fine_run(const Problem& problem, Real size,
                                                       TaskRunner* runner) {
  const Real step = problem.end / (4.0 * problem.step_counts.back());
  Run fine(validation::with_method(problem.scene, IntegratorId::runge_kutta_4, step), runner);
  fine.advance_to(problem.end);
  return [expected = all_positions(fine), size](const Run& run) {
    const std::vector<Vec3> positions = all_positions(run);
    if (positions.size() != expected.size()) return std::numeric_limits<Real>::quiet_NaN();
    Real sum = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      sum += (positions[i] - expected[i]).squaredNorm();
    }
    return std::sqrt(sum / static_cast<Real>(positions.size())) / size;
  };
}

}  // namespace vat::bench
