#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/accuracy/problem.h"

namespace vat::bench {

/// An integrator and a step control.
struct Method {
  IntegratorId integrator;
  StepControl control;
};
/// Returns every integrator with every step control.
std::vector<Method> all_methods();
/// Returns a name such as "velocity_verlet, adaptive".
std::string name_of(const Method& method);

/// One solution of a problem.
struct Solution {
  Method method;
  Real step = 0;       ///< [s]; the longest of variable control
  Real tolerance = 0;  ///< of variable control
  Real error = 0;      ///< relative; not a number if the run failed
  double seconds = 0;  ///< median
  std::uint64_t steps = 0;
  std::uint64_t force_evaluations = 0;
  Real evaluations_per_particle = 0;
  std::uint64_t state_hash = 0;
  std::string failure;  ///< reason of a missing error; empty if there is one
};

struct SweepSettings {
  int repetitions = 5;       ///< timed, after one that warms the caches; fewer for long runs
  std::size_t stride = 1;    ///< uses every stride-th step of the problem
  double longest_run = 0.4;  ///< [s]; a method's sweep ends with the first run that takes longer
};

/// Solves the problem with decreasing steps, except those for which the scene is invalid. Throws
/// std::logic_error if two runs of one solution end in different states.
std::vector<Solution> sweep(const Problem& problem, const Method& method,
                            const SweepSettings& settings, TaskRunner* runner);

/// Returns the Pareto front of error and cost, by increasing cost.
std::vector<Solution> pareto_front(const std::vector<Solution>& solutions,
                                   double (*cost)(const Solution&));

/// Returns the cheapest solution with an error of at most `error`, if all finer solutions of its
/// method have that too. Errors of opposite signs may cancel in single solutions. `solutions` must
/// be in the order of sweep().
std::optional<Solution> cheapest(const std::vector<Solution>& solutions, Real error,
                                 double (*cost)(const Solution&));

double seconds_of(const Solution& solution);
double evaluations_of(const Solution& solution);

}  // namespace vat::bench
