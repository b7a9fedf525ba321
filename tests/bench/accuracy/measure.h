#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/accuracy/problem.h"

namespace vat::bench {

/// How a scene is solved.
struct Method {
  IntegratorId integrator;
  StepControl control;
};
/// Every integrator with every step control.
std::vector<Method> all_methods();
/// Such as "velocity_verlet, adaptive".
std::string name_of(const Method& method);

/// One solution of a problem.
struct Solution {
  Method method;
  Real step = 0;       ///< [s]; of varied control the longest
  Real tolerance = 0;  ///< of varied control
  Real error = 0;      ///< relative; not a number where the run failed
  double seconds = 0;  ///< median
  std::uint64_t steps = 0;
  std::uint64_t force_evaluations = 0;
  Real evaluations_per_particle = 0;
  std::uint64_t state_hash = 0;
  std::string failure;  ///< why there is no error; empty: there is one
};

struct SweepSettings {
  int repetitions = 5;       ///< timed, after one that warms the caches; fewer of long runs
  std::size_t stride = 1;    ///< every how-manieth step of the problem is tried
  double longest_run = 0.4;  ///< [s]; a method's sweep ends with the run that takes longer
};

/// Solves the problem with ever finer steps; those with which the scene is not valid are left out.
/// Throws std::logic_error where two runs of one solution end in different states.
std::vector<Solution> sweep(const Problem& problem, const Method& method,
                            const SweepSettings& settings, TaskRunner* runner);

/// Those that no other is better than in both error and cost, in the order of rising cost.
std::vector<Solution> pareto_front(const std::vector<Solution>& solutions,
                                   double (*cost)(const Solution&));

/// The cheapest one with an error of at most `error` that its method also keeps with every finer
/// solution: errors of opposite signs cancel here and there. `solutions` are as sweep() gives them.
std::optional<Solution> cheapest(const std::vector<Solution>& solutions, Real error,
                                 double (*cost)(const Solution&));

double seconds_of(const Solution& solution);
double evaluations_of(const Solution& solution);

}  // namespace vat::bench
