#include "core/numerics/choose_numerics.h"

#include <algorithm>
#include <cmath>

#include "core/limits.h"
#include "core/numerics/error_model.h"
#include "core/numerics/step_limits.h"
#include "core/support/check.h"

namespace vat {
namespace {

constexpr Real kMargin = 0.9;     // in stable steps
constexpr Real kEvaluations = 4;  // of Runge-Kutta 4

bool needs_verlet(const Scene& scene) {
  return std::ranges::any_of(scene.materials, [](const Material& material) {
    return material.implicit_springs || material.elongation_limit;
  });
}

/// The motions of a scene, as bounds of their rates.
struct Motions {
  std::vector<Oscillation> smooth;  ///< springs and the central field
  std::vector<Oscillation> liquid;  ///< adaptive control measures its actual rates
  bool has_kinks = false;           ///< liquids, contacts, walls
};

bool has_projection(const Scene& scene) {
  return scene.default_interface.law == InterfaceLaw::projection ||
         std::ranges::any_of(scene.interfaces, [](const InterfaceDescription& interface) {
           return interface.constants.law == InterfaceLaw::projection;
         });
}

Motions find_motions(const Scene& scene, std::span<const SampledBody* const> samples) {
  Motions motions;
  motions.has_kinks = has_projection(scene);
  for (const OscillatingPart& part : find_oscillating_parts(scene, samples)) {
    const bool is_body = part.path.starts_with("/bodies/");
    const std::size_t body = is_body ? std::stoul(part.path.substr(8)) : 0;
    const bool is_liquid = is_body && (scene.bodies[body].kind == BodyKind::liquid ||
                                       part.path.ends_with(kMeltingPath));
    if (is_body && !is_liquid && scene.bodies[body].kind == BodyKind::deformable) {
      motions.smooth.push_back(part.limiting());
    } else if (part.bound.omega2 > 0 || part.bound.rate > 0) {
      motions.has_kinks = true;
      if (is_body) motions.liquid.push_back(part.limiting());
    }
  }
  if (scene.forces.gravity && scene.central_field) {
    const Real omega = scene.central_field->angular_frequency;
    motions.smooth.push_back({omega * omega, 0});
  }
  return motions;
}

/// The longest step of the integrator for which smooth motions have the error and all motions are
/// stable.
Real longest_step(const Motions& motions, IntegratorId integrator, Real error) {
  VAT_CHECK(error > 0);
  Real step = kMaxStep;
  for (const Oscillation& motion : motions.liquid) {
    step = std::min(step, kMargin * stable_step(integrator, motion));
  }
  for (const Oscillation& motion : motions.smooth) {
    const Real rate = std::sqrt(motion.omega2 + motion.rate * motion.rate);
    if (rate == 0) continue;
    step = std::min({step, kMargin * stable_step(integrator, motion),
                     resolving_phase(integrator, error) / rate});
  }
  return step;
}

}  // namespace

Numerics choose_numerics(const Scene& scene, std::span<const SampledBody* const> samples) {
  Numerics numerics = scene.numerics;
  if (!numerics.accuracy) return numerics;
  const Real error = *numerics.accuracy / kAccurateRadians;
  const Motions motions = find_motions(scene, samples);
  const bool is_incompressible = scene.pressure_solver == PressureSolver::incompressible;
  numerics.integrator =
      is_incompressible ? IntegratorId::symplectic_euler : IntegratorId::velocity_verlet;
  numerics.tolerance = std::max(error, kMinAccuracy);
  Real step = longest_step(motions, numerics.integrator, error);
  if (motions.has_kinks || is_incompressible) {
    numerics.control = StepControl::adaptive;
  } else {
    numerics.control = StepControl::fixed;
    const Real longer = longest_step(motions, IntegratorId::runge_kutta_4, error);
    if (!needs_verlet(scene) && longer > kEvaluations * step) {
      numerics.integrator = IntegratorId::runge_kutta_4;
      step = longer;
    }
  }
  numerics.step = numerics.tick / std::ceil(numerics.tick / step);
  return numerics;
}

void resolve_accuracy(Scene& scene) {
  if (!scene.numerics.accuracy) return;
  const std::vector<SampledBody> bodies = sample_bodies(scene);
  scene.numerics = choose_numerics(scene, pointers_to(bodies));
}

}  // namespace vat
