#include <cmath>

#include "tests/bench/accuracy/problem.h"
#include "tests/validation/reference.h"

namespace vat::bench {

using validation::reference;
using validation::reference_vector;
using validation::Run;

namespace {

Problem pendulum(TaskRunner*) {
  return {.title = "Pendulum on a stiff spring",
          .error_name = "place at t = 5 s, in lengths of the pendulum",
          .scene = validation::load_scene("DEF-4"),
          .end = 5,
          .step_counts = doubled(400, 9),
          .error = [](const Run& run) {
            const Vec3 place = run.body().positions[1];
            return std::hypot(place.x() - reference("/deformable/DEF-4b_k10000/state/5/0"),
                              place.y() - reference("/deformable/DEF-4b_k10000/state/5/1"));
          }};
}

Problem beam(TaskRunner*) {
  constexpr std::size_t kTip = 10 * 9 + 1 * 3 + 1;
  return {.title = "Swinging beam of springs",
          .error_name = "height of the tip at t = 1 s, in static deflections",
          .scene = validation::load_scene("DEF-5"),
          .end = 1,
          .step_counts = doubled(500, 6),
          .error = [](const Run& run) {
            const Real expected = reference("/deformable/DEF-5/dynamic_release/tip_z/1.0");
            const Real size = std::abs(reference("/deformable/DEF-5/tip_deflection/2"));
            return std::abs(run.body().positions[kTip].z() - expected) / size;
          }};
}

Problem cube(TaskRunner*) {
  return {.title = "Cube of springs in free flight",
          .error_name = "place of a corner at t = 5 s, in edges of the cube",
          .scene = validation::load_scene("DEF-6b"),
          .end = 5,
          .step_counts = doubled(125, 9),
          .error = [](const Run& run) {
            const Vec3 expected = reference_vector("/deformable/DEF-6b/corner_ppp/5");
            return (run.body().positions[7] - expected).norm();
          }};
}

}  // namespace

std::vector<ProblemEntry> deformable_problems() {
  return {{"DEF-4", pendulum}, {"DEF-5", beam}, {"DEF-6b", cube}};
}

}  // namespace vat::bench
