#include <cmath>

#include "tests/bench/accuracy/problem.h"
#include "tests/validation/reference.h"

namespace vat::bench {

using validation::reference;
using validation::Run;

namespace {

Problem spinning_top(TaskRunner*) {
  return {.title = "Free asymmetric top",
          .error_name = "attitude at t = 10 s, in radians",
          .scene = validation::load_scene("RIG-1"),
          .end = 10,
          .step_counts = doubled(100, 8),
          .error = [](const Run& run) {
            const Json& q = validation::reference_at("/rigid/RIG-1/quat/10");
            const Quat exact(q.at(0).get<Real>(), q.at(1).get<Real>(), q.at(2).get<Real>(),
                             q.at(3).get<Real>());
            return run.body().pose->orientation.angularDistance(exact.normalized());
          }};
}

/// The ball is in free flight after two complete bounces, so only the flight time matters.
Real bounce_height(Real time) {
  const Real cycle = reference("/rigid/RIG-4a/period_full");
  const Real in_flight = time - 2 * cycle;
  return 1 - 0.5 * reference("/g") * in_flight * in_flight;
}

Problem bounce(TaskRunner*) {
  constexpr Real kEnd = 2;
  constexpr Real kRadius = 0.05;
  return {.title = "Ball that bounces on a stiff floor",
          .error_name = "height after two bounces, in heights of the fall",
          .scene = validation::load_scene("RIG-4"),
          .end = kEnd,
          .step_counts = doubled(200, 10),
          .longest_step_count = 200,
          .error = [](const Run& run) {
            const Real height = run.body().positions[0].z() - kRadius;
            return std::abs(height - bounce_height(kEnd));
          }};
}

/// The relative motion is free flight, half a sine during contact, and free flight.
Problem collision(TaskRunner*) {
  constexpr Real kEnd = 0.04;
  return {.title = "Two balls collide",
          .error_name = "place of the first ball afterwards, in its way since the impact",
          .scene = validation::load_scene("RIG-5"),
          .end = kEnd,
          .step_counts = doubled(25, 10),
          .longest_step_count = 25,
          .error = [](const Run& run) {
            constexpr Real kGap = 0.02;
            constexpr Real kSpeed = 3;
            const Real after = kEnd - kGap / kSpeed - reference("/rigid/RIG-5a/contact_time");
            const Real distance = 0.1 + kSpeed * after;
            const Real expected = 0.02 - 2.0 / 3.0 * distance;  // for a centre of mass at rest
            return std::abs(run.body().positions[0].x() - expected) / (2 * after);
          }};
}

/// The scene with projections of this restitution, and its friction, instead of springs.
Scene with_projections(Scene scene, Real restitution) {
  const auto project = [&](InterfaceConstants& constants) {
    constants = {.friction = constants.friction,
                 .law = InterfaceLaw::projection,
                 .restitution = restitution};
  };
  project(scene.default_interface);
  for (InterfaceDescription& interface : scene.interfaces) project(interface.constants);
  return scene;
}

/// A collision without contact duration.
Problem hard_collision(TaskRunner* runner) {
  Problem problem = collision(runner);
  problem.title = "Two balls collide, by projection";
  problem.scene = with_projections(problem.scene, 1);
  problem.step_counts = doubled(5, 10);
  problem.longest_step_count = 5;
  problem.error = [end = problem.end](const Run& run) {
    constexpr Real kGap = 0.02;
    const Real after = end - kGap / 3;
    const Real expected = -2.0 / 3.0 * 0.1 + 0.02 - 2 * after;
    return std::abs(run.body().positions[0].x() - expected) / (2 * after);
  };
  return problem;
}

/// A block that slides until it stops.
Problem slide(TaskRunner*) {
  return {.title = "A block slides to its stop",
          .error_name = "way to the stop, in that way",
          .scene = validation::load_scene("RIG-7"),
          .end = 1,
          .step_counts = doubled(1000, 8),
          .longest_step_count = 1000,
          .error = [](const Run& run) {
            const Real way = reference("/rigid/RIG-7/stop_distance");
            return std::abs(run.body().positions[0].x() / way - 1);
          }};
}

Problem hard_slide(TaskRunner* runner) {
  Problem problem = slide(runner);
  problem.title = "A block slides to its stop, by projection";
  problem.scene = with_projections(problem.scene, 0);
  problem.scene.bodies[0].position.z() = 0.05;
  problem.step_counts = doubled(32, 8);
  problem.longest_step_count = 32;
  return problem;
}

}  // namespace

std::vector<ProblemEntry> rigid_problems() {
  return {{"RIG-1", spinning_top}, {"RIG-4", bounce},
          {"RIG-5", collision},    {"RIG-5-projection", hard_collision},
          {"RIG-7", slide},        {"RIG-7-projection", hard_slide}};
}

}  // namespace vat::bench
