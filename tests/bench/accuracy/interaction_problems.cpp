#include <cmath>
#include <utility>

#include "tests/bench/accuracy/problem.h"
#include "tests/support/scenes.h"
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

/// Mostly free flight and slow oscillation, for which steps that suit the contact are unnecessarily
/// short.
Problem impact(TaskRunner* runner) {
  Problem problem{.title = "Ball that hits a cube of springs",
                  .error_name = "places against a fine run, in ways from the start",
                  .scene = validation::load_scene("INT-impact"),
                  .end = 1,
                  .step_counts = doubled(100, 9),
                  .longest_step_count = 100,
                  .error = {}};
  // The contact starts and ends with kinks, where Runge-Kutta has second order only.
  problem.error = error_against_fine_run(problem, 16, runner);
  return problem;
}

constexpr Real kPoolSpacing = 0.05;  // [m]

/// A jelly of 27 particles falls into a pool of 320. Its stiffness needs 20 times shorter steps
/// than the liquid.
Scene make_pool() {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-4);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {test::make_liquid("water", 1000, {100, 5, 2 * kPoolSpacing}),
                     test::make_material("jelly")};
  scene.default_interface = {1000, 1};
  scene.vat = Vat{Vec3(-0.2, -0.2, -0.125), Vec3(0.2, 0.2, 0.6), false, {}};
  const std::vector<Vec3> block = test::make_lattice(3, 3, 3, kPoolSpacing);
  BodyDescription jelly = test::make_body("jelly", BodyKind::deformable, "jelly",
                                          test::make_particles(block, 0.1), kPoolSpacing / 2);
  jelly.springs = test::join_near(block, 1.5 * kPoolSpacing, {1e6, 1});
  jelly.position = {0.01, -0.005, 0.25};
  jelly.velocity = {0, 0, -1};
  scene.bodies = {
      test::make_body("pool", BodyKind::liquid, "water",
                      test::make_particles(test::make_lattice(8, 8, 5, kPoolSpacing), 0.125),
                      kPoolSpacing / 2),
      std::move(jelly)};
  return scene;
}

/// The same with a weakly compressible liquid, whose speed of sound is 10 m/s. The jelly needs ten
/// times shorter steps.
Scene make_tait_pool() {
  Scene scene = make_pool();
  scene.pressure_solver = PressureSolver::tait;
  scene.materials[0] = test::make_liquid("water", 1000, {100, 0.5, 2.5 * kPoolSpacing});
  return scene;
}

/// A soft ball of 19 particles sinks into cold honey. It needs no shorter steps than the honey.
Scene make_honey_pool() {
  Scene scene = make_tait_pool();
  scene.materials[0] = test::make_liquid("water", 1400, {64, 600, 2.5 * kPoolSpacing});
  BodyDescription& ball = scene.bodies[1];
  ball.name = "ball";
  std::erase_if(std::get<ParticleShape>(ball.shape).positions,
                [](const Vec3& x) { return x.norm() > 1.5 * kPoolSpacing; });
  const std::vector<Vec3> points = std::get<ParticleShape>(ball.shape).positions;
  ball.shape = test::make_particles(points, 0.2);
  ball.springs = test::join_near(points, 1.5 * kPoolSpacing, {1000, 1});
  return scene;
}

/// Twenty boats of four particles drift on a pool of 720, and collide. Their hulls need steps of a
/// third of a millisecond, but only while they touch.
Scene make_boats() {
  Scene scene = make_tait_pool();
  scene.materials[1] = test::make_material("steel");
  scene.default_interface = {1e6, 10};
  scene.vat = Vat{Vec3(-0.5, -0.3, -0.075), Vec3(0.5, 0.3, 0.6), false, {}};
  scene.bodies = {test::make_body(
      "pool", BodyKind::liquid, "water",
      test::make_particles(test::make_lattice(20, 12, 3, kPoolSpacing), 0.125), kPoolSpacing / 2)};
  const ParticleShape hull =
      test::make_particles(test::make_lattice(2, 2, 1, kPoolSpacing), 0.0625);
  for (int n = 0; n < 20; ++n) {
    BodyDescription boat = test::make_body("boat " + std::to_string(n), BodyKind::rigid, "steel",
                                           hull, kPoolSpacing / 2);
    boat.position = {0.19 * (n % 5 - 2), 0.14 * (n / 5 - 1.5), 0.11};
    boat.velocity = {0.1, n / 5 % 2 == 0 ? 0.5 : -0.5, 0};
    scene.bodies.push_back(std::move(boat));
  }
  return scene;
}

/// A rope of 40 light particles holds a weight of 500 times their mass, and falls from the
/// horizontal. Each particle of the rope needs short steps, and the weight is joined to one.
Problem rope(TaskRunner* runner) {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-4);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {test::make_material("rope")};
  std::vector<Vec3> points;
  for (int n = 0; n <= 40; ++n) points.emplace_back(kPoolSpacing * n, 0, 0);
  ParticleShape shape = test::make_particles(points, 0.02);
  shape.masses.back() = 10;
  shape.fixed = {0};
  scene.bodies = {test::make_body("rope", BodyKind::deformable, "rope", std::move(shape), 0.01)};
  scene.bodies[0].springs = test::join_near(points, 1.5 * kPoolSpacing, {2e4, 0.1});
  Problem problem{.title = "Rope with a heavy end",
                  .error_name = "places against a fine run, in ways from the start",
                  .scene = std::move(scene),
                  .end = 0.4,
                  .step_counts = doubled(400, 5),
                  .longest_step_count = 50,
                  .longest_step_growth = 2,
                  .error = {}};
  problem.error = error_against_fine_run(problem, 1, runner);
  return problem;
}

Problem pool_problem(const char* title, Scene scene, TaskRunner* runner) {
  Problem problem{.title = title,
                  .error_name = "places against a fine run, in ways from the start",
                  .scene = std::move(scene),
                  .end = 0.1,
                  .step_counts = doubled(1000, 3),
                  .longest_step_count = 50,
                  .longest_step_growth = 2,
                  .error = {}};
  problem.error = error_against_fine_run(problem, 1, runner);
  return problem;
}

}  // namespace

std::vector<ProblemEntry> interaction_problems() {
  return {{"INT-6", push},
          {"INT-impact", impact},
          {"rope", rope},
          {"pool",
           [](TaskRunner* runner) {
             return pool_problem("Stiff jelly that falls into a pool", make_pool(), runner);
           },
           true},
          {"tait-pool",
           [](TaskRunner* runner) {
             return pool_problem("Stiff jelly that falls into a weakly compressible pool",
                                 make_tait_pool(), runner);
           },
           true},
          {"honey-pool",
           [](TaskRunner* runner) {
             return pool_problem("Soft ball in honey", make_honey_pool(), runner);
           },
           true},
          {"boats",
           [](TaskRunner* runner) {
             return pool_problem("Twenty boats that collide", make_boats(), runner);
           },
           true}};
}

}  // namespace vat::bench
