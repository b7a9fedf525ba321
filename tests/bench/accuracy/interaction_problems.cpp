#include <cmath>
#include <utility>

#include "tests/bench/accuracy/problem.h"
#include "tests/validation/reference.h"

namespace vat::bench {

namespace {

Problem push(TaskRunner*) {
  Scene scene = validation::load_scene("INT-6");
  scene.interfaces[0].constants.stiffness = 1e4;
  return {.title = "Ball that hits a dumbbell on a spring",
          .error_name = "velocity of the ball afterwards, in velocities before",
          .scene = std::move(scene),
          .end = 0.2,
          .step_counts = doubled(20, 11),
          .longest_step_count = 20,
          .error = [](const validation::Run& run) {
            return std::abs(run.body("ball").velocities[0].x() -
                            validation::reference("/interaction/INT-6/kc=10000/v1"));
          }};
}

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
  return {{"INT-6", push}, {"INT-impact", impact}};
}

}  // namespace vat::bench
