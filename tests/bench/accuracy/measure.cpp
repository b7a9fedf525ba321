#include "tests/bench/accuracy/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include <stdexcept>
#include <utility>

#include "core/limits.h"
#include "tests/bench/report/quantile.h"
#include "tests/validation/order.h"

namespace vat::bench {

using validation::Run;

namespace {

/// Returns tolerances that start at the longest stable step. Each is a quarter of the previous one,
/// as second-order errors decrease when steps are halved.
Real tolerance_of(std::size_t index) {
  return kMaxTolerance * std::pow(0.25, static_cast<Real>(index));
}

/// The first tolerances do not shorten the stable steps.
constexpr std::size_t kFinerTolerances = 2;

bool is_varied(const Method& method) {
  return method.control != StepControl::fixed;
}

std::uint32_t step_count_of(const Problem& problem, bool varied, std::size_t index) {
  if (!varied || problem.longest_step_count == 0) return problem.step_counts[index];
  std::uint32_t count = problem.longest_step_count;
  for (std::size_t i = 0; i < index; ++i) count *= problem.longest_step_growth;
  return count;
}

Scene scene_for(const Problem& problem, const Method& method, std::size_t index) {
  const bool varied = is_varied(method);
  const std::uint32_t count = step_count_of(problem, varied, index);
  Scene scene = validation::with_method(problem.scene, method.integrator, problem.end / count);
  scene.numerics.control = method.control;
  if (varied) scene.numerics.tolerance = tolerance_of(index);
  return scene;
}

/// Runs to the end, and compares the result with that of earlier repetitions.
double run_once(const Problem& problem, const Scene& scene, TaskRunner* runner,
                Solution& solution) {
  Run run(scene, runner);
  run.advance_to(problem.end);
  solution.error = problem.error(run);
  solution.steps = run.steps();
  solution.force_evaluations = run.force_evaluations();
  solution.evaluations_per_particle = static_cast<Real>(run.particle_evaluations()) /
                                      static_cast<Real>(run.simulation().particle_count());
  solution.state_hash = run.state_hash();
  return run.seconds();
}

void time_runs(const Problem& problem, const Scene& scene, const SweepSettings& settings,
               TaskRunner* runner, Solution& solution) {
  std::vector<double> seconds;
  const double first = run_once(problem, scene, runner, solution);
  const std::uint64_t hash = solution.state_hash;
  double total = 0;
  for (int i = 0; i < settings.repetitions && total < settings.longest_run; ++i) {
    seconds.push_back(run_once(problem, scene, runner, solution));
    total += seconds.back();
    if (solution.state_hash == hash) continue;
    throw std::logic_error(problem.title + ": two equal runs end in different states");
  }
  solution.seconds = seconds.empty() ? first : median(std::move(seconds));
}

Solution solve(const Problem& problem, const Scene& scene, const SweepSettings& settings,
               TaskRunner* runner) {
  const Numerics& numerics = scene.numerics;
  Solution solution{.method = {numerics.integrator, numerics.control},
                    .step = numerics.step,
                    .tolerance = numerics.control == StepControl::fixed ? 0 : numerics.tolerance,
                    .failure = {}};
  try {
    time_runs(problem, scene, settings, runner, solution);
    if (!std::isfinite(solution.error)) solution.failure = "not finite";
  } catch (const std::runtime_error& error) {
    solution.error = std::numeric_limits<Real>::quiet_NaN();
    solution.failure = error.what();
  } catch (const std::invalid_argument&) {
    solution.error = std::numeric_limits<Real>::quiet_NaN();
    solution.failure = "not for this method";
  }
  return solution;
}

bool is_solved(const Solution& solution) {
  return solution.failure.empty();
}

}  // namespace

std::vector<Method> all_methods() {
  std::vector<Method> methods;
  for (const StepControl control :
       {StepControl::fixed, StepControl::adaptive, StepControl::local}) {
    for (const IntegratorId integrator : validation::kIntegrators) {
      methods.push_back({integrator, control});
    }
  }
  return methods;
}

std::string name_of(const Method& method) {
  return std::string(to_string(method.integrator)) + ", " + to_string(method.control);
}

std::vector<Solution> sweep(const Problem& problem, const Method& method,
                            const SweepSettings& settings, TaskRunner* runner) {
  std::vector<Solution> solutions;
  const bool has_own_steps = is_varied(method) && problem.longest_step_count > 0;
  const std::size_t count = problem.step_counts.size() + (has_own_steps ? kFinerTolerances : 0);
  for (std::size_t i = 0; i < count; i += settings.stride) {
    const Scene scene = scene_for(problem, method, i);
    if (!Simulation::create(scene, runner))
      continue;  // the step is too long, or the method is not available
    solutions.push_back(solve(problem, scene, settings, runner));
    if (solutions.back().seconds > settings.longest_run) break;
  }
  return solutions;
}

std::vector<Solution> pareto_front(const std::vector<Solution>& solutions,
                                   double (*cost)(const Solution&)) {
  std::vector<Solution> sorted;
  std::ranges::copy_if(solutions, std::back_inserter(sorted), is_solved);
  std::ranges::stable_sort(sorted, {}, cost);
  std::vector<Solution> front;
  for (const Solution& solution : sorted) {
    if (front.empty() || solution.error < front.back().error) front.push_back(solution);
  }
  return front;
}

std::optional<Solution> cheapest(const std::vector<Solution>& solutions, Real error,
                                 double (*cost)(const Solution&)) {
  std::optional<Solution> best;
  for (const Method& method : all_methods()) {
    for (auto at = solutions.rbegin(); at != solutions.rend(); ++at) {
      const Solution& solution = *at;
      if (name_of(solution.method) != name_of(method)) continue;
      if (!is_solved(solution) || !(solution.error <= error)) break;
      if (!best || cost(solution) < cost(*best)) best = solution;
    }
  }
  return best;
}

double seconds_of(const Solution& solution) {
  return solution.seconds;
}

double evaluations_of(const Solution& solution) {
  return solution.evaluations_per_particle;
}

}  // namespace vat::bench
