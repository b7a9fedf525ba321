#include "core/scene/choose_numerics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/limits.h"
#include "core/scene/error_model.h"
#include "core/scene/step_limits.h"

namespace vat {
namespace {

constexpr Real kMargin = 0.9;      // of the stable step
constexpr Real kSoundShare = 0.2;  // c dt / h: 0.4 of h_s = h / 2
constexpr Real kEvaluations = 4;   // of Runge-Kutta 4

/// What of a scene moves, and how fast.
struct Motions {
  std::vector<Oscillation> smooth;                          ///< springs and the central field
  Real sound_step = std::numeric_limits<Real>::infinity();  ///< [s]
  bool has_kinks = false;                                   ///< liquids, contacts, walls
};

Motions find_motions(const Scene& scene, std::span<const SampledBody* const> samples) {
  Motions motions;
  for (const OscillatingPart& part : find_oscillating_parts(scene, samples)) {
    const bool is_body = part.path.starts_with("/bodies/");
    const std::size_t body = is_body ? std::stoul(part.path.substr(8)) : 0;
    if (is_body && scene.bodies[body].kind == BodyKind::deformable) {
      motions.smooth.push_back(part.bound);
    } else if (part.bound.omega2 > 0 || part.bound.rate > 0) {
      motions.has_kinks = true;
    }
  }
  if (scene.forces.gravity && scene.central_field) {
    const Real omega = scene.central_field->angular_frequency;
    motions.smooth.push_back({omega * omega, 0});
  }
  for (const BodyDescription& body : scene.bodies) {
    if (body.kind != BodyKind::liquid || !scene.forces.pressure) continue;
    const LiquidConstants& liquid =
        *std::ranges::find(scene.materials, body.material, &Material::name)->liquid;
    if (liquid.stiffness == 0) continue;
    motions.sound_step = std::min(
        motions.sound_step, kSoundShare * liquid.support_radius / std::sqrt(liquid.stiffness));
  }
  return motions;
}

/// The longest step of the integrator for the smooth motions.
Real smooth_step(const Motions& motions, IntegratorId integrator, Real error) {
  Real step = kMaxStep;
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
  numerics.integrator = IntegratorId::velocity_verlet;
  numerics.tolerance = std::max(error, kMinAccuracy);
  Real step = std::min(motions.sound_step, smooth_step(motions, numerics.integrator, error));
  if (motions.has_kinks) {
    numerics.control = StepControl::adaptive;
  } else {
    numerics.control = StepControl::fixed;
    const Real longer = smooth_step(motions, IntegratorId::runge_kutta_4, error);
    if (longer > kEvaluations * step) {
      numerics.integrator = IntegratorId::runge_kutta_4;
      step = longer;
    }
  }
  numerics.step = numerics.tick / std::ceil(numerics.tick / step);
  return numerics;
}

void resolve_accuracy(Scene& scene) {
  if (!scene.numerics.accuracy) return;
  std::vector<SampledBody> bodies;
  for (const BodyDescription& body : scene.bodies) {
    const Material& material = *std::ranges::find(scene.materials, body.material, &Material::name);
    bodies.push_back(sample_body(body, material, scene.dimensions));
  }
  scene.numerics = choose_numerics(scene, pointers_to(bodies));
}

}  // namespace vat
