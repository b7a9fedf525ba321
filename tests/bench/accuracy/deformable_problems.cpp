#include <cmath>
#include <utility>

#include "tests/bench/accuracy/problem.h"
#include "tests/support/scenes.h"
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

/// The stiffness makes it a pendulum of constant length. After 5/4 of its period it hangs
/// vertically, stretched by three times its weight. The earlier stretching delays it by 2e-6
/// lengths.
Problem stiff_pendulum(TaskRunner*) {
  constexpr Real kStiffness = 1e8;  // [N/m]
  Scene scene = validation::load_scene("DEF-4");
  scene.bodies[0].springs[0].constants.stiffness = kStiffness;
  return {.title = "Pendulum on a spring as stiff as steel",
          .error_name = "place after 5/4 of a period, in lengths of the pendulum",
          .scene = std::move(scene),
          .end = 1.25 * reference("/deformable/DEF-4a/period/90"),
          .step_counts = doubled(16000, 5),
          .error = [](const Run& run) {
            const Real length = 1 + 3 * reference("/g") / kStiffness;
            return (run.body().positions[1] - Vec3(0, -length, 0)).norm();
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

/// The same problem with implicit springs, with steps from eight times the length.
Problem with_implicit_springs(Problem problem) {
  problem.title += ", implicit springs";
  for (Material& material : problem.scene.materials) material.implicit_springs = true;
  problem.step_counts =
      doubled(problem.step_counts.front() / 8, static_cast<int>(problem.step_counts.size()) + 3);
  return problem;
}

Problem implicit_pendulum(TaskRunner* runner) {
  return with_implicit_springs(pendulum(runner));
}
Problem implicit_stiff_pendulum(TaskRunner* runner) {
  Problem problem = with_implicit_springs(stiff_pendulum(runner));
  problem.step_counts = doubled(32, 12);
  return problem;
}
Problem implicit_beam(TaskRunner* runner) {
  return with_implicit_springs(beam(runner));
}
Problem implicit_cube(TaskRunner* runner) {
  return with_implicit_springs(cube(runner));
}

constexpr Real kLampSpacing = 0.1;  // [m]
constexpr Real kSoft = 1e3;         // [N/m]
constexpr Real kStiff = 1e6;

/// A soft cube of 512 particles that hangs on a stiff one of 8, which is fixed at a corner.
BodyDescription make_lamp() {
  std::vector<Vec3> points = test::make_lattice(8, 8, 8, kLampSpacing);
  std::vector<SpringDescription> springs = test::join_near(points, 1.5 * kLampSpacing, {kSoft, 0});
  const auto first = static_cast<Index>(points.size());
  std::vector<Vec3> holder = test::make_lattice(2, 2, 2, kLampSpacing);
  for (SpringDescription spring : test::join_near(holder, 1.5 * kLampSpacing, {kStiff, 0})) {
    spring.a += first;
    spring.b += first;
    springs.push_back(spring);
  }
  for (Vec3& point : holder) {
    point.z() += 5 * kLampSpacing;
    points.push_back(point);
  }
  for (Index a = 0; a < first; ++a) {
    for (Index b = first; b < points.size(); ++b) {
      if ((points[a] - points[b]).norm() > 1.1 * kLampSpacing) continue;
      springs.push_back({a, b, {kSoft, 0}, {}});
    }
  }
  BodyDescription lamp = test::make_body("lamp", BodyKind::deformable, "rubber",
                                         test::make_particles(points, 0.01), 0.01);
  lamp.springs = std::move(springs);
  std::get<ParticleShape>(lamp.shape).fixed = {first + 4};
  return lamp;
}

/// One part in 65 needs 30 times shorter steps than the others.
Problem lamp(TaskRunner* runner) {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 5e-5);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {test::make_material("rubber")};
  scene.bodies = {make_lamp()};
  Problem problem{.title = "Soft cube that hangs on a small stiff one",
                  .error_name = "places against a fine run, in ways from the start",
                  .scene = std::move(scene),
                  .end = 0.1,
                  .step_counts = doubled(2000, 3),
                  .longest_step_count = 100,
                  .longest_step_growth = 2,
                  .error = {}};
  problem.error = error_against_fine_run(problem, 1, runner);
  return problem;
}

}  // namespace

std::vector<ProblemEntry> deformable_problems() {
  return {{"DEF-4", pendulum},
          {"DEF-5", beam},
          {"DEF-6b", cube},
          {"lamp", lamp, true},
          {"DEF-4-stiff", stiff_pendulum},
          {"DEF-4-implicit", implicit_pendulum},
          {"DEF-4-stiff-implicit", implicit_stiff_pendulum},
          {"DEF-5-implicit", implicit_beam},
          {"DEF-6b-implicit", implicit_cube}};
}

}  // namespace vat::bench
