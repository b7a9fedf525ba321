#include <cmath>

#include "tests/bench/accuracy/problem.h"

namespace vat::bench {

namespace {

/// Almost all of it is free flight and slow swinging: steps that fit the contact are wasted there.
Problem impact(TaskRunner* runner) {
  Problem problem{.title = "Ball that hits a cube of springs",
                  .error_name = "places against a fine run, in ways from the start",
                  .scene = validation::load_scene("INT-impact"),
                  .end = 1,
                  .step_counts = doubled(100, 9),
                  .longest_step_count = 100,
                  .error = {}};
  // The contact begins and ends with kinks, at which Runge-Kutta is of second order only.
  problem.error = error_against_fine_run(problem, 16, runner);
  return problem;
}

}  // namespace

std::vector<ProblemEntry> interaction_problems() {
  return {{"INT-impact", impact}};
}

}  // namespace vat::bench
