#include "core/stepping/control/step_control_liquid.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/numerics/step_limits.h"
#include "core/stepping/control/step_control_contacts.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kLiquidTravelShare = 0.25;  // of the support radius, for each of two particles

/// The bound of a body's own forces: sound and viscosity; or pressure, if viscosity is solved.
Oscillation liquid_bound(const Model& model, std::size_t body, Real pressure) {
  if (!model.is_incompressible) return compressed(model, model.damping.own[body]);
  const LiquidModel& constants = *model.liquids[model.bodies[body].material];
  const Real rate = solves_damping(model.scene) ? 0 : model.damping.own[body].rate;
  return {pressed_lattice_omega2(pressure / constants.rest_density, constants.support_radius),
          rate};
}

}  // namespace

Real travel_time(Real way, Real speed, Real acceleration) {
  if (acceleration == 0) return way / speed;
  return 2 * way / (speed + std::sqrt(speed * speed + 4 * acceleration * way));
}

Oscillation compressed(const Model& model, const Oscillation& liquid) {
  if (model.is_coupled) return liquid;  // its bound includes the compression
  const Real share = compressed_step_share(model.scene.dimensions);
  return {liquid.omega2 / (share * share), liquid.rate};
}

Real step_of_liquid(const Model& model, std::size_t body, const LiquidMotion& motion) {
  VAT_CHECK(model.bodies[body].kind == BodyKind::liquid);
  const LiquidModel& liquid = *model.liquids[model.bodies[body].material];
  const Real way = kLiquidTravelShare * liquid.support_radius;
  return std::min(safe_step(model.scene.numerics, liquid_bound(model, body, motion.pressure)),
                  travel_time(way, motion.speed, motion.acceleration));
}

std::size_t lasting_rank(std::size_t count) {
  constexpr std::size_t kRare = 100;
  VAT_CHECK(count > 0);
  return count - 1 - (count - 1) / kRare;
}

// A heap of the highest pressures finds the result in one pass.
Real lasting_pressure(std::span<const Real> pressures, std::vector<Real>& highest) {
  if (pressures.empty()) return 0;
  const std::size_t count = pressures.size() - lasting_rank(pressures.size());
  highest.assign(pressures.begin(), pressures.begin() + static_cast<std::ptrdiff_t>(count));
  std::ranges::make_heap(highest, std::greater());
  for (const Real pressure : pressures.subspan(count)) {
    if (!(pressure > highest.front())) continue;
    std::ranges::pop_heap(highest, std::greater());
    highest.back() = pressure;
    std::ranges::push_heap(highest, std::greater());
  }
  return highest.front();
}

Real step_of_particles(Real own_step, Real travel, Real speed) {
  return std::min(own_step, travel_time(kTravelShare * travel, speed, 0));
}

}  // namespace vat
