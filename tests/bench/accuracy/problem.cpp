#include "tests/bench/accuracy/problem.h"

#include <cmath>
#include <iterator>
#include <stdexcept>

#include "core/support/check.h"
#include "protocol/scene/scene_json.h"

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

/// Returns the root mean square distance between two lists of the same particles.
Real root_mean_square(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return distance(a, b) / std::sqrt(static_cast<Real>(a.size()));
}

std::vector<ProblemEntry> collect() {
  std::vector<ProblemEntry> problems;
  for (const auto group : {deformable_problems, rigid_problems, liquid_problems,
                           interaction_problems, catalogue_problems}) {
    std::ranges::move(group(), std::back_inserter(problems));
  }
  return problems;
}

}  // namespace

const std::vector<ProblemEntry>& all_problems() {
  static const std::vector<ProblemEntry> problems = collect();
  return problems;
}

Scene load_catalogue(const std::string& name) {
  Result<Scene> scene = read_scene_file(VAT_DEFAULT_SCENES_DIR "/" + name + ".json");
  if (!scene) throw std::runtime_error(name + " is not a scene of the catalogue");
  return std::move(scene).value();
}

std::vector<Vec3> centers_of(const Run& run) {
  std::vector<Vec3> centers;
  for (const BodyDiagnostics& body : run.diagnostics().bodies) {
    centers.push_back(body.center_of_mass);
  }
  return centers;
}

Real distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  VAT_CHECK(a.size() == b.size());
  Real sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

std::vector<std::uint32_t> doubled(std::uint32_t first, int count) {
  std::vector<std::uint32_t> counts;
  for (int i = 0; i < count; ++i) counts.push_back(first << i);
  return counts;
}

std::function<Real(const Run&)> error_against_fine_run(const Problem& problem, int factor,
                                                       TaskRunner* runner) {
  const Real step = problem.end / (static_cast<Real>(factor) * problem.step_counts.back());
  Run fine(validation::with_method(problem.scene, IntegratorId::runge_kutta_4, step), runner);
  const std::vector<Vec3> start = all_positions(fine);
  fine.advance_to(problem.end);
  const std::vector<Vec3> expected = all_positions(fine);
  return [expected, size = root_mean_square(start, expected)](const Run& run) {
    return root_mean_square(all_positions(run), expected) / size;
  };
}

}  // namespace vat::bench
