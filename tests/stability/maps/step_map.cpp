#include "tests/stability/maps/step_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/limits.h"
#include "core/simulation/simulation.h"
#include "tests/stability/builders.h"

namespace vat::stability {
namespace {

Real greatest_displacement(const LinearCase& linear, const Simulation& simulation) {
  Real greatest = 0;
  std::size_t i = 0;
  for (const BodyView& body : simulation.bodies()) {
    for (const Vec3& position : body.positions) {
      greatest = std::max(greatest, (position - linear.rest[i++]).norm());
    }
  }
  return greatest;
}

bool is_stable(const LinearCase& linear, IntegratorId integrator, Real step, int steps) {
  constexpr Real kUnbounded = 1000;
  Scene scene = linear.scene;
  scene.numerics = {integrator, step, step};
  Simulation simulation = test::make_simulation(scene);
  Real halves[2] = {linear.displacement, 0};
  for (int n = 0; n < steps; ++n) {
    if (simulation.advance(1).undone_steps > 0) return false;
    const Real displacement = greatest_displacement(linear, simulation);
    if (!(displacement < kUnbounded * linear.displacement)) return false;
    Real& half = halves[2 * n < steps ? 0 : 1];
    half = std::max(half, displacement);
  }
  return halves[1] <= 2 * halves[0];
}

}  // namespace

Real theoretical_step(const LinearCase& linear, IntegratorId integrator) {
  Real least = std::numeric_limits<Real>::infinity();
  for (const Oscillation& mode : linear.modes) {
    least = std::min(least, stable_step(integrator, mode));
  }
  return least;
}

Real largest_stable_part(const LinearCase& linear, IntegratorId integrator, Real step, int steps) {
  Real low = 0.25;
  Real high = 1.5;
  if (!is_stable(linear, integrator, low * step, steps)) return 0;
  while (high - low > 1.0 / 128) {
    const Real middle = (low + high) / 2;
    (is_stable(linear, integrator, middle * step, steps) ? low : high) = middle;
  }
  return low;
}

namespace {

StepMapPoint empty_point(const LinearCase& linear, IntegratorId integrator, Real theory) {
  Real fastest = 0;
  for (const Oscillation& mode : linear.modes) {
    fastest = std::max({fastest, mode.omega2, mode.rate * mode.rate / 4});
  }
  return {linear.body,        integrator, linear.stiffness, linear.mass_ratio, linear.damping_ratio,
          std::sqrt(fastest), theory};
}

constexpr int kLongestDecade = 5;  // of omega dt

}  // namespace

Real longest_tried_step(Real frequency) {
  return std::min(kMaxStep, std::pow(Real{10}, kLongestDecade) / frequency);
}

StepMapPoint map_point_without_limit(const LinearCase& linear, IntegratorId integrator) {
  StepMapPoint point = empty_point(linear, integrator, std::numeric_limits<Real>::infinity());
  for (int decade = 0; decade <= kLongestDecade; ++decade) {
    const Real step = std::min(kMaxStep, std::pow(Real{10}, decade) / point.frequency);
    if (!is_stable(linear, integrator, step, linear.steps)) break;
    point.measured = step;
    if (step == kMaxStep) break;
  }
  return point;
}

StepMapPoint map_point(const LinearCase& linear, IntegratorId integrator) {
  constexpr Real kGrowing = 1.5;  // omega dt
  StepMapPoint point = empty_point(linear, integrator, theoretical_step(linear, integrator));
  if (point.theory > 0) {
    point.measured =
        point.theory * largest_stable_part(linear, integrator, point.theory, linear.steps);
  } else if (is_stable(linear, integrator, kGrowing / point.frequency, linear.steps)) {
    point.measured = kGrowing / point.frequency;  // not a result of theory
  }
  return point;
}

}  // namespace vat::stability
