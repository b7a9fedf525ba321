#include <utility>

#include "tests/bench/accuracy/problem.h"

namespace vat::bench {

namespace {

const char* const kErrorName = "places against a fine run, in ways from the start";

/// A quarter of a validation scene, which is uniform across the wave.
Scene narrow(const std::string& name) {
  constexpr Real kWidth = 0.4;
  Scene scene = validation::load_scene(name);
  for (const int axis : {1, 2}) scene.periodic->max[axis] = scene.periodic->min[axis] + kWidth;
  auto& box = std::get<BoxShape>(scene.bodies[0].shape);
  for (const int axis : {1, 2}) {
    box.size[axis] = kWidth;
    box.center[axis] = scene.periodic->min[axis] + kWidth / 2;
  }
  return scene;
}

Problem with_fine_run(Problem problem, TaskRunner* runner) {
  problem.error = error_against_fine_run(problem, 4, runner);
  return problem;
}

Problem sound(TaskRunner* runner) {
  return with_fine_run({.title = "Sound wave",
                        .error_name = kErrorName,
                        .scene = narrow("LIQ-4"),
                        .end = 0.15,
                        .step_counts = doubled(10, 6),
                        .error = {}},
                       runner);
}

Problem shear(TaskRunner* runner) {
  return with_fine_run({.title = "Shear wave that viscosity stops",
                        .error_name = kErrorName,
                        .scene = narrow("LIQ-5"),
                        .end = 5,
                        .step_counts = doubled(50, 6),
                        .error = {}},
                       runner);
}

/// Half the resolution of the validation case, since the time error does not depend on it.
Problem drop(TaskRunner* runner) {
  Scene scene = validation::load_scene("LIQ-9a");
  scene.bodies[0].spacing *= 2;
  scene.materials[0].liquid->support_radius *= 2;
  return with_fine_run({.title = "Drop that is drawn out",
                        .error_name = kErrorName,
                        .scene = std::move(scene),
                        .end = 0.004,
                        .step_counts = doubled(50, 5),
                        .error = {}},
                       runner);
}

}  // namespace

std::vector<ProblemEntry> liquid_problems() {
  return {{"LIQ-4", sound}, {"LIQ-5", shear}, {"LIQ-9a", drop}};
}

}  // namespace vat::bench
